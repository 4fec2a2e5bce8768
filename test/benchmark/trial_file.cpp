#include "trial_file.h"

#include <cmath>
#include <iomanip>
#include <stdexcept>

TrialFile::TrialFile(const std::string& path) {
  if (path.empty()) return;
  file_.open(path);
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  file_ << "row,pair,accepted,method,error_m,turn_deg,wrong,score,overlap,matches,sigma_m,refusal\n";
}

void TrialFile::add(const std::string& row, const Trial& trial, const TrialOutcome& outcome) {
  const pcl_fft_ground::core::Alignment& alignment = outcome.alignment;
  const double sigma = std::sqrt(alignment.covariance(0, 0) + alignment.covariance(1, 1));
  file_ << std::quoted(row) << ',' << trial.name << ',' << alignment.accepted << ','
        << nameOf(alignment.method) << ',' << outcome.error << ',' << outcome.turn << ',' << outcome.wrong()
        << ',' << alignment.score << ',' << alignment.overlap << ',' << alignment.matches.size() << ','
        << sigma << ',' << std::quoted(alignment.refusal, '"', '"') << '\n';
}
