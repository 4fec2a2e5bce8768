#include "pcl_fft_ground/core/survey/survey_tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_fft_ground::core {
namespace {

constexpr double WRONG = 0.05;  // an alignment that is off by more is a false one [m]

/// The results of each method on the chain, methods in the order of their first results.
std::vector<std::pair<std::string, std::vector<const PairResult*>>> byMethod(
    const std::vector<PairResult>& results) {
  std::vector<std::pair<std::string, std::vector<const PairResult*>>> groups;
  for (const PairResult& result : results) {
    if (result.kind != PairKind::CHAIN) continue;
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == result.method; });
    if (group == groups.end()) group = groups.insert(group, {result.method, {}});
    group->second.push_back(&result);
  }
  return groups;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of the sample; 0 of a single value.
double deviationOf(const std::vector<double>& values) {
  const double mean = meanOf(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return values.size() < 2 ? 0.0 : std::sqrt(sum / static_cast<double>(values.size() - 1));
}

CrispnessRow crispnessRow(const std::string& method, const std::vector<const PairResult*>& results) {
  CrispnessRow row;
  row.method = method;
  std::vector<double> changes;
  for (const PairResult* result : results) {
    const double change = result->crispnessChange();
    if (result->status == PairStatus::NOT_RUN && row.not_run.empty()) row.not_run = result->refusal;
    if (result->status == PairStatus::UNPROCESSED || result->status == PairStatus::NOT_RUN)
      ++row.unprocessed;
    else
      ++(change > 0 ? row.rose : change < 0 ? row.fell : row.not_computed);
    if (change != 0) changes.push_back(change);
  }
  if (changes.empty()) return row;
  row.mean = meanOf(changes);
  row.deviation = deviationOf(changes);
  return row;
}

AccuracyRow accuracyRow(const std::string& method, const std::vector<const PairResult*>& results) {
  AccuracyRow row;
  row.method = method;
  std::vector<double> translations, rotations;
  for (const PairResult* result : results) {
    const bool is_aligned = result->status == PairStatus::ALIGNED;
    if (result->isOverlapping()) ++row.overlapping;
    if (result->isOverlapping() && is_aligned) ++row.aligned;
    if (!is_aligned || !result->translation_error) continue;
    if (*result->translation_error > WRONG) ++row.wrong;
    translations.push_back(*result->translation_error);
    rotations.push_back(result->rotation_error.value_or(0));
  }
  row.aligned_bound = lowerBound(row.aligned, row.overlapping);
  row.median_translation = quantileOf(translations, 0.5);
  row.high_translation = quantileOf(translations, 0.9);
  row.median_rotation = quantileOf(rotations, 0.5);
  row.high_rotation = quantileOf(rotations, 0.9);
  return row;
}

}  // namespace

std::vector<CrispnessRow> crispnessTable(const std::vector<PairResult>& results) {
  std::vector<CrispnessRow> rows;
  for (const auto& [method, group] : byMethod(results)) rows.push_back(crispnessRow(method, group));
  return rows;
}

std::vector<AccuracyRow> accuracyTable(const std::vector<PairResult>& results) {
  std::vector<AccuracyRow> rows;
  for (const auto& [method, group] : byMethod(results)) rows.push_back(accuracyRow(method, group));
  return rows;
}

double lowerBound(std::size_t successes, std::size_t trials) {
  constexpr double Z = 1.2815515655446004;  // of a normal distribution 10 % lie beyond
  if (trials == 0) return 0;
  const auto n = static_cast<double>(trials);
  const double share = static_cast<double>(successes) / n;
  const double spread = Z * std::sqrt(share * (1 - share) / n + Z * Z / (4 * n * n));
  return std::max(0.0, (share + Z * Z / (2 * n) - spread) / (1 + Z * Z / n));
}

std::optional<double> quantileOf(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, rank));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace pcl_fft_ground::core
