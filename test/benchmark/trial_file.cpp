#include "trial_file.h"

#include <cmath>
#include <iomanip>
#include <stdexcept>

namespace core = pcl_fft_ground::core;

namespace {

const char* nameOf(core::AlignmentMethod method) {
  switch (method) {
    case core::AlignmentMethod::SEGMENTS:
      return "segments";
    case core::AlignmentMethod::DENSE:
      return "dense";
    case core::AlignmentMethod::NONE:
      break;
  }
  return "none";
}

}  // namespace

TrialFile::TrialFile(const std::string& path) {
  if (path.empty()) return;
  file_.open(path);
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  file_ << "row,pair,accepted,method,error_m,turn_deg,wrong,score,overlap,matches,sigma_m,refusal\n";
}

void TrialFile::add(const std::string& row, const Trial& trial, const TrialOutcome& outcome) {
  const core::Alignment& alignment = outcome.alignment;
  const double sigma = std::sqrt(alignment.covariance(0, 0) + alignment.covariance(1, 1));
  file_ << std::quoted(row) << ',' << trial.name << ',' << alignment.accepted << ','
        << nameOf(alignment.method) << ',' << outcome.error << ',' << outcome.turn << ',' << outcome.wrong()
        << ',' << alignment.score << ',' << alignment.overlap << ',' << alignment.matches.size() << ','
        << sigma << ',' << std::quoted(alignment.refusal, '"', '"') << '\n';
}
