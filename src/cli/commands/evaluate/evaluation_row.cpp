#include "commands/evaluate/evaluation_row.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_fft_ground::cli {
namespace {

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

/// A measure of the counts, which a row without scores does not have.
Measure ofCounts(const char* name, double (core::Confusion::*measure)() const) {
  return {name, [measure](const EvaluationRow& row) { return (row.confusion.*measure)(); }};
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

}  // namespace pcl_fft_ground::cli
