#include "commands/evaluate/evaluation_files.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// The counts and their names, in the order of the files.
std::array<std::pair<const char*, std::size_t>, 4> countsOf(const EvaluationRow& row) {
  return {{{"tp", row.confusion.true_positives},
           {"fp", row.confusion.false_positives},
           {"tn", row.confusion.true_negatives},
           {"fn", row.confusion.false_negatives}}};
}

}  // namespace

std::string asCsv(const std::vector<EvaluationRow>& rows) {
  std::ostringstream csv;
  csv << "cloud,method";
  for (const auto& [name, count] : countsOf({})) csv << ',' << name;
  for (const Measure& measure : measures()) csv << ',' << measure.name;
  csv << ",failure\n" << std::setprecision(9);
  for (const EvaluationRow& row : rows) {
    csv << std::quoted(row.cloud, '"', '"') << ',' << row.method;
    for (const auto& [name, count] : countsOf(row)) csv << ',' << count;
    for (const Measure& measure : measures()) {
      const double value = measure.of(row);
      csv << ',';
      if (!std::isnan(value)) csv << value;
    }
    csv << ',' << std::quoted(row.failure, '"', '"') << '\n';
  }
  return csv.str();
}

ordered_json asJson(const std::vector<EvaluationRow>& rows) {
  ordered_json results = ordered_json::array(), means;
  for (const EvaluationRow& row : rows) {
    ordered_json result{{"cloud", row.cloud}, {"method", row.method}};
    for (const auto& [name, count] : countsOf(row)) result[name] = count;
    for (const Measure& measure : measures()) result[measure.name] = measure.of(row);
    if (!row.failure.empty()) result["failure"] = row.failure;
    results.push_back(result);
  }
  for (const std::string& method : distinct(rows, &EvaluationRow::method))
    for (const Measure& measure : measures()) means[method][measure.name] = meanOf(rows, method, measure);
  return {{"results", results}, {"means", means}};
}

}  // namespace pcl_fft_ground::cli
