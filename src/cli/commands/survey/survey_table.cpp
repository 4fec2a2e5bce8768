#include "commands/survey/survey_table.h"

#include <iomanip>
#include <sstream>

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

constexpr int NAME_WIDTH = 14;

/// A number with a fixed count of decimals; as the paper has it, "Nan" where there is none.
std::string cell(const std::optional<double>& value, double factor, int decimals) {
  if (!value) return "Nan";
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << factor * *value;
  return text.str();
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
  for (const CrispnessRow& row : rows)
    printCells(out, headings,
               {row.method, cell(row.mean, 1, 2), cell(row.deviation, 1, 2), std::to_string(row.rose),
                std::to_string(row.not_computed), std::to_string(row.fell), std::to_string(row.unprocessed)});
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

ordered_json orNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

}  // namespace

void printTables(std::ostream& out, const std::vector<CrispnessRow>& crispness,
                 const std::vector<AccuracyRow>& accuracy) {
  printCrispness(out, crispness);
  out << '\n';
  printAccuracy(out, accuracy);
}

ordered_json asJson(const std::vector<CrispnessRow>& rows) {
  ordered_json result = ordered_json::array();
  for (const CrispnessRow& row : rows)
    result.push_back({{"method", row.method},
                      {"mean_delta_nx", orNull(row.mean)},
                      {"std_delta_nx", orNull(row.deviation)},
                      {"rose", row.rose},
                      {"not_computed", row.not_computed},
                      {"fell", row.fell},
                      {"unprocessed", row.unprocessed}});
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

}  // namespace pcl_fft_ground::cli
