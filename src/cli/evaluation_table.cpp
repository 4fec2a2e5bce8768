#include "evaluation_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

struct Measure {
  const char* name;
  std::function<double(const EvaluationRow&)> of;
};

/// Every measure that a row has, in the order of the files; the first three are those of Table I.
const std::vector<Measure>& measures() {
  static const std::vector<Measure> list{
      {"tpr", [](const EvaluationRow& r) { return r.confusion.truePositiveRate(); }},
      {"tnr", [](const EvaluationRow& r) { return r.confusion.trueNegativeRate(); }},
      {"f1", [](const EvaluationRow& r) { return r.confusion.f1(); }},
      {"precision", [](const EvaluationRow& r) { return r.confusion.precision(); }},
      {"iou", [](const EvaluationRow& r) { return r.confusion.intersectionOverUnion(); }},
      {"total_error", [](const EvaluationRow& r) { return r.confusion.totalError(); }},
      {"kappa", [](const EvaluationRow& r) { return r.confusion.kappa(); }},
      {"surface_rmse",
       [](const EvaluationRow& r) {
         return r.surface_rmse.value_or(std::numeric_limits<double>::quiet_NaN());
       }},
      {"seconds", [](const EvaluationRow& r) { return r.seconds; }}};
  return list;
}

/// The different values of a member, in the order of their first appearance.
std::vector<std::string> distinct(const std::vector<EvaluationRow>& rows,
                                  std::string EvaluationRow::*member) {
  std::vector<std::string> values;
  for (const EvaluationRow& row : rows)
    if (std::find(values.begin(), values.end(), row.*member) == values.end()) values.push_back(row.*member);
  return values;
}

/// Mean of a measure over the rows of a method that have it.
double meanOf(const std::vector<EvaluationRow>& rows, const std::string& method, const Measure& measure) {
  double sum = 0, count = 0;
  for (const EvaluationRow& row : rows) {
    const double value = measure.of(row);
    if (row.method != method || !row.failure.empty() || std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

std::string cell(double value) {
  if (std::isnan(value)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << value;
  return text.str();
}

void printLine(std::ostream& out, const std::string& method, const std::vector<EvaluationRow>& rows,
               const std::string& cloud) {
  out << "  " << std::left << std::setw(12) << method << std::right;
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const EvaluationRow& r) {
    return r.method == method && (cloud.empty() || r.cloud == cloud);
  });
  if (!cloud.empty() && !row->failure.empty()) {
    out << "  " << row->failure << '\n';
    return;
  }
  for (const Measure& measure : measures())
    out << std::setw(13) << cell(cloud.empty() ? meanOf(rows, method, measure) : measure.of(*row));
  out << '\n';
}

void printBlock(std::ostream& out, const std::string& title, const std::vector<EvaluationRow>& rows,
                const std::string& cloud) {
  out << title << "\n  " << std::setw(12) << "";
  for (const Measure& measure : measures()) out << std::setw(13) << measure.name;
  out << '\n';
  for (const std::string& method : distinct(rows, &EvaluationRow::method))
    printLine(out, method, rows, cloud);
}

}  // namespace

void printTable(std::ostream& out, const std::vector<EvaluationRow>& rows) {
  const std::vector<std::string> clouds = distinct(rows, &EvaluationRow::cloud);
  for (const std::string& cloud : clouds)
    printBlock(out, std::filesystem::path(cloud).filename().string(), rows, cloud);
  if (clouds.size() > 1) printBlock(out, "mean of " + std::to_string(clouds.size()) + " clouds", rows, "");
}

std::string asCsv(const std::vector<EvaluationRow>& rows) {
  std::ostringstream csv;
  csv << "cloud,method,tp,fp,tn,fn";
  for (const Measure& measure : measures()) csv << ',' << measure.name;
  csv << ",failure\n" << std::setprecision(9);
  for (const EvaluationRow& row : rows) {
    csv << std::quoted(row.cloud, '"', '"') << ',' << row.method << ',' << row.confusion.true_positives << ','
        << row.confusion.false_positives << ',' << row.confusion.true_negatives << ','
        << row.confusion.false_negatives;
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
    ordered_json result{{"cloud", row.cloud},
                        {"method", row.method},
                        {"tp", row.confusion.true_positives},
                        {"fp", row.confusion.false_positives},
                        {"tn", row.confusion.true_negatives},
                        {"fn", row.confusion.false_negatives}};
    for (const Measure& measure : measures()) result[measure.name] = measure.of(row);
    if (!row.failure.empty()) result["failure"] = row.failure;
    results.push_back(result);
  }
  for (const std::string& method : distinct(rows, &EvaluationRow::method))
    for (const Measure& measure : measures()) means[method][measure.name] = meanOf(rows, method, measure);
  return {{"results", results}, {"means", means}};
}

}  // namespace pcl_fft_ground::cli
