#include "survey/survey_report.h"

#include <array>

#include "drawing/axes.h"
#include "pcl_fft_ground/core/crispness.h"
#include "survey/survey_table.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// One way of placing the sub-maps, and how crisp the whole is then.
struct Placement {
  const char* name;
  const std::vector<Eigen::Isometry3d>& poses;
  std::size_t voxels;
};

std::array<Placement, 3> placementsOf(const GlobalResult& global) {
  return {{{"navigation", global.poses.navigation, global.crispness.navigation},
           {"chained", global.poses.chained, global.crispness.chained},
           {"global", global.poses.global, global.crispness.global}}};
}

void printPlacement(std::ostream& out, const SurveyFolder& survey, const Placement& placement,
                    std::size_t voxels_before) {
  out << "  " << placement.name << ": " << groupedNumber(static_cast<long long>(placement.voxels))
      << " occupied voxels (" << fixedNumber(core::crispnessChange(voxels_before, placement.voxels), 2)
      << " %)";
  if (!survey.truth.empty()) {
    const PoseErrors errors = poseErrors(survey, placement.poses);
    out << ", error " << fixedNumber(1000 * errors.rms_translation, 1) << " mm rms, "
        << fixedNumber(1000 * errors.max_translation, 1) << " mm at most, "
        << fixedNumber(errors.median_rotation, 3) << " degrees";
  }
  out << '\n';
}

}  // namespace

ordered_json makeSurveyReport(const SurveyFolder& survey, const std::vector<PairResult>& results,
                              const GlobalResult& global, const ordered_json& parameters) {
  ordered_json placements;
  for (const Placement& placement : placementsOf(global)) {
    placements[placement.name]["occupied_voxels"] = placement.voxels;
    if (!survey.truth.empty())
      placements[placement.name]["errors"] = asJson(poseErrors(survey, placement.poses));
  }
  return {{"submaps", survey.submaps.size()},
          {"crispness", asJson(crispnessTable(results))},
          {"accuracy", asJson(accuracyTable(results))},
          {"global",
           {{"method", global.method},
            {"edges", global.poses.edges},
            {"rejected_edges", global.poses.rejected_edges},
            {"placements", placements}}},
          {"parameters", parameters}};
}

void printSurvey(std::ostream& out, const SurveyFolder& survey, const std::vector<PairResult>& results,
                 const GlobalResult& global) {
  printTables(out, crispnessTable(results), accuracyTable(results));
  out << "\nGlobal alignment by " << global.method << ": " << global.poses.edges << " aligned pairs, "
      << global.poses.rejected_edges << " of them rejected\n";
  for (const Placement& placement : placementsOf(global))
    printPlacement(out, survey, placement, global.crispness.navigation);
}

}  // namespace pcl_fft_ground::cli
