#include "commands/survey/survey_report.h"

#include <algorithm>
#include <cmath>

#include "commands/survey/survey_table.h"
#include "pcl_fft_ground/core/align/crispness.h"
#include "pictures/axes.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

void printPlacement(std::ostream& out, const Placement& placement, std::size_t voxels_before) {
  out << "  " << placement.name << ": " << groupedNumber(static_cast<long long>(placement.voxels))
      << " occupied voxels (" << fixedNumber(core::crispnessChange(voxels_before, placement.voxels), 2)
      << " %)";
  if (placement.errors)
    out << ", error " << fixedNumber(1000 * placement.errors->rms_translation, 1) << " mm rms, "
        << fixedNumber(1000 * placement.errors->max_translation, 1) << " mm at most, "
        << fixedNumber(placement.errors->median_rotation, 3) << " degrees";
  out << '\n';
}

/// The errors of one way of placing over all surveys; none if one of them has no truth.
std::optional<PoseErrors> pooledErrors(const std::vector<SurveyOutcome>& outcomes, std::size_t placement) {
  PoseErrors all;
  double squares = 0, submaps = 0;
  std::vector<double> turns;
  for (const SurveyOutcome& outcome : outcomes) {
    const std::optional<PoseErrors>& errors = outcome.placements.at(placement).errors;
    if (!errors) return std::nullopt;
    const auto count = static_cast<double>(outcome.submaps);
    squares += count * errors->rms_translation * errors->rms_translation;
    submaps += count;
    all.max_translation = std::max(all.max_translation, errors->max_translation);
    turns.push_back(errors->median_rotation);
  }
  all.rms_translation = std::sqrt(squares / submaps);
  all.median_rotation = quantileOf(turns, 0.5).value_or(0);
  return all;
}

}  // namespace

ordered_json makeSurveyReport(const SurveyOutcome& outcome, const std::string& mapping) {
  ordered_json placements;
  for (const Placement& placement : outcome.placements) {
    placements[placement.name]["occupied_voxels"] = placement.voxels;
    if (placement.errors) placements[placement.name]["errors"] = asJson(*placement.errors);
  }
  return {{"submaps", outcome.submaps},
          {"crispness", asJson(crispnessTable(outcome.pairs))},
          {"accuracy", asJson(accuracyTable(outcome.pairs))},
          {"global",
           {{"method", mapping},
            {"edges", outcome.edges},
            {"rejected_edges", outcome.rejected_edges},
            {"placements", placements}}}};
}

void printSurvey(std::ostream& out, const SurveyOutcome& outcome, const std::string& mapping) {
  out << outcome.name << ": " << outcome.submaps << " sub-maps\n";
  printTables(out, crispnessTable(outcome.pairs), accuracyTable(outcome.pairs));
  out << "\nGlobal alignment by " << mapping << ": " << outcome.edges << " aligned pairs, "
      << outcome.rejected_edges << " of them rejected\n";
  for (const Placement& placement : outcome.placements)
    printPlacement(out, placement, outcome.placements[0].voxels);
  out << '\n';
}

SurveyOutcome pooled(const std::vector<SurveyOutcome>& outcomes) {
  SurveyOutcome all;
  all.name = "all " + std::to_string(outcomes.size()) + " surveys together";
  all.placements = outcomes.front().placements;
  for (Placement& placement : all.placements) placement.voxels = 0;
  for (const SurveyOutcome& outcome : outcomes) {
    all.submaps += outcome.submaps;
    all.pairs.insert(all.pairs.end(), outcome.pairs.begin(), outcome.pairs.end());
    all.edges += outcome.edges;
    all.rejected_edges += outcome.rejected_edges;
    for (std::size_t n = 0; n < all.placements.size(); ++n)
      all.placements[n].voxels += outcome.placements[n].voxels;
  }
  for (std::size_t n = 0; n < all.placements.size(); ++n)
    all.placements[n].errors = pooledErrors(outcomes, n);
  return all;
}

}  // namespace pcl_fft_ground::cli
