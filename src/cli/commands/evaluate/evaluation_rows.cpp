#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include "commands/evaluate/evaluation_table.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

/// A measure of the counts, which a row without scores does not have.
Measure ofCounts(const char* name, double (core::Confusion::*measure)() const) {
  return {name, [measure](const EvaluationRow& row) { return (row.confusion.*measure)(); }};
}

/// The counts and their names, in the order of the files.
std::array<std::pair<const char*, std::size_t>, 4> countsOf(const EvaluationRow& row) {
  return {{{"tp", row.confusion.true_positives},
           {"fp", row.confusion.false_positives},
           {"tn", row.confusion.true_negatives},
           {"fn", row.confusion.false_negatives}}};
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> list{
      ofCounts("tpr", &core::Confusion::truePositiveRate),
      ofCounts("tnr", &core::Confusion::trueNegativeRate),
      ofCounts("f1", &core::Confusion::f1),
      ofCounts("precision", &core::Confusion::precision),
      ofCounts("iou", &core::Confusion::intersectionOverUnion),
      ofCounts("total_error", &core::Confusion::totalError),
      ofCounts("kappa", &core::Confusion::kappa),
      {"surface_rmse", [](const EvaluationRow& row) { return row.surface_rmse.value_or(NONE); }},
      {"seconds", [](const EvaluationRow& row) { return row.failure.empty() ? row.seconds : NONE; }}};
  return list;
}

std::vector<std::string> distinct(const std::vector<EvaluationRow>& rows,
                                  std::string EvaluationRow::*member) {
  std::vector<std::string> values;
  for (const EvaluationRow& row : rows)
    if (std::find(values.begin(), values.end(), row.*member) == values.end()) values.push_back(row.*member);
  return values;
}

double meanOf(const std::vector<EvaluationRow>& rows, const std::string& method, const Measure& measure) {
  double sum = 0, count = 0;
  for (const EvaluationRow& row : rows) {
    const double value = measure.of(row);
    if (row.method != method || std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : NONE;
}

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
