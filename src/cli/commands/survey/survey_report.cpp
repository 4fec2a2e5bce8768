#include "commands/survey/survey_report.h"

#include <algorithm>
#include <iomanip>

#include "pcl_fft_ground/core/align/crispness.h"
#include "pcl_fft_ground/core/survey/survey_tables.h"
#include "pcl_fft_ground/version.h"
#include "printable.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using core::AccuracyRow;
using core::CrispnessRow;
using nlohmann::ordered_json;

constexpr int NAME_WIDTH = 14;

/// A number with a fixed count of decimals; as the paper has it, "Nan" where there is none.
std::string cell(const std::optional<double>& value, double factor, int decimals) {
  return value ? fixedNumber(factor * *value, decimals) : "Nan";
}

/// A line of cells, each as wide as its heading.
void printCells(std::ostream& out, const std::vector<std::string>& headings,
                const std::vector<std::string>& cells) {
  out << "  " << std::left << std::setw(NAME_WIDTH) << cells[0] << std::right;
  for (std::size_t i = 1; i < cells.size(); ++i)
    out << std::setw(static_cast<int>(headings[i].size()) + 2) << cells[i];
  out << '\n';
}

void printCrispness(std::ostream& out, const std::vector<CrispnessRow>& rows) {
  const std::vector<std::string> headings{"",        "mean dNx [%]", "std dNx [%]", "dNx > 0",
                                          "dNx = 0", "dNx < 0",      "unprocessed"};
  out << "Crispness before and after alignment (Table II)\n";
  printCells(out, headings, headings);
  for (const CrispnessRow& row : rows) {
    printCells(out, headings,
               {row.method, cell(row.mean, 1, 2), cell(row.deviation, 1, 2), std::to_string(row.rose),
                std::to_string(row.not_computed), std::to_string(row.fell), std::to_string(row.unprocessed)});
    if (!row.not_run.empty()) out << "    " << row.not_run << '\n';
  }
}

bool isKnown(const std::vector<AccuracyRow>& rows) {
  for (const AccuracyRow& row : rows)
    if (row.median_translation) return true;
  return false;
}

void printAccuracy(std::ostream& out, const std::vector<AccuracyRow>& rows) {
  const std::vector<std::string> headings{"",           "aligned",           "at least [%]",
                                          "> 5 cm off", "median, 90 % [mm]", "median, 90 % [deg]"};
  out << "Overlapping pairs" << (isKnown(rows) ? ", and residuals against the truth\n" : "\n");
  printCells(out, headings, headings);
  for (const AccuracyRow& row : rows) {
    const auto known = [&](const std::string& text) {
      return row.median_translation ? text : std::string("-");
    };
    printCells(out, headings,
               {row.method, std::to_string(row.aligned) + "/" + std::to_string(row.overlapping),
                cell(row.aligned_bound, 100, 0), known(std::to_string(row.wrong)),
                known(cell(row.median_translation, 1000, 1) + ", " + cell(row.high_translation, 1000, 1)),
                known(cell(row.median_rotation, 1, 3) + ", " + cell(row.high_rotation, 1, 3))});
  }
}

ordered_json asJson(const std::vector<CrispnessRow>& rows) {
  ordered_json result = ordered_json::array();
  for (const CrispnessRow& row : rows) {
    result.push_back({{"method", row.method},
                      {"mean_delta_nx", orNull(row.mean)},
                      {"std_delta_nx", orNull(row.deviation)},
                      {"rose", row.rose},
                      {"not_computed", row.not_computed},
                      {"fell", row.fell},
                      {"unprocessed", row.unprocessed}});
    if (!row.not_run.empty()) result.back()["not_run"] = row.not_run;
  }
  return result;
}

ordered_json asJson(const std::vector<AccuracyRow>& rows) {
  ordered_json result = ordered_json::array();
  for (const AccuracyRow& row : rows)
    result.push_back({{"method", row.method},
                      {"overlapping", row.overlapping},
                      {"aligned", row.aligned},
                      {"aligned_share_lower_bound", row.aligned_bound},
                      {"wrong_by_more_than_5_cm", row.wrong},
                      {"translation_median", orNull(row.median_translation)},
                      {"translation_90_percent", orNull(row.high_translation)},
                      {"rotation_median_degrees", orNull(row.median_rotation)},
                      {"rotation_90_percent_degrees", orNull(row.high_rotation)}});
  return result;
}

ordered_json asJson(const core::PoseErrors& errors) {
  return {{"translation_rms", errors.rms_translation},
          {"translation_max", errors.max_translation},
          {"rotation_median_degrees", errors.median_rotation}};
}

ordered_json asJson(const std::vector<LeftOut>& left_out) {
  ordered_json result = ordered_json::array();
  for (const LeftOut& file : left_out) result.push_back({{"submap", file.name}, {"reason", file.reason}});
  return result;
}

ordered_json asJson(const std::vector<FileRemark>& remarks) {
  ordered_json result = ordered_json::array();
  for (const FileRemark& file : remarks) result.push_back(file.path + ": " + file.remark);
  return result;
}

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
std::optional<core::PoseErrors> pooledErrors(const std::vector<SurveyOutcome>& outcomes,
                                             std::size_t placement) {
  std::vector<core::PoseErrors> errors;
  for (const SurveyOutcome& outcome : outcomes) {
    if (!outcome.placements.at(placement).errors) return std::nullopt;
    errors.push_back(*outcome.placements.at(placement).errors);
  }
  return core::pooled(errors);
}

}  // namespace

ordered_json makeSurveyReport(const SurveyOutcome& outcome, const std::string& mapping) {
  ordered_json placements;
  for (const Placement& placement : outcome.placements) {
    placements[placement.name]["occupied_voxels"] = placement.voxels;
    if (placement.errors) placements[placement.name]["errors"] = asJson(*placement.errors);
  }
  return {{"version", PCL_FFT_GROUND_VERSION},
          {"submaps", outcome.submaps},
          {"left_out", outcome.left_out.size()},
          {"left_out_files", asJson(outcome.left_out)},
          {"warnings", asJson(outcome.remarks)},
          {"voxel_size", outcome.voxel_sizes},
          {"crispness", asJson(core::crispnessTable(outcome.pairs))},
          {"accuracy", asJson(core::accuracyTable(outcome.pairs))},
          {"global",
           {{"method", mapping},
            {"edges", outcome.edges},
            {"rejected_edges", outcome.rejected_edges},
            {"placements", placements}}}};
}

void printTables(std::ostream& out, const std::vector<core::PairResult>& pairs) {
  printCrispness(out, core::crispnessTable(pairs));
  out << '\n';
  printAccuracy(out, core::accuracyTable(pairs));
}

void printSurvey(std::ostream& out, const SurveyOutcome& outcome, const std::string& mapping) {
  out << printable(outcome.name) << ": " << outcome.submaps << " sub-maps";
  if (!outcome.left_out.empty()) out << ", " << outcome.left_out.size() << " left out";
  out << '\n';
  printTables(out, outcome.pairs);
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
    all.left_out.insert(all.left_out.end(), outcome.left_out.begin(), outcome.left_out.end());
    all.remarks.insert(all.remarks.end(), outcome.remarks.begin(), outcome.remarks.end());
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
