#include "commands/evaluate/evaluation_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace pcl_fft_ground::cli {
namespace {

EvaluationRow makeRow(const std::string& cloud, const std::string& method, const core::Confusion& confusion) {
  EvaluationRow row;
  row.cloud = cloud;
  row.method = method;
  row.confusion = confusion;
  return row;
}

/// Rows of two methods on some clouds; TPR 0.9 and 0.6, TNR 0.8 and 1, on all of them.
std::vector<EvaluationRow> rowsOf(const std::vector<std::string>& clouds) {
  std::vector<EvaluationRow> rows;
  for (const std::string& cloud : clouds) {
    rows.push_back(makeRow(cloud, "naive", {9, 2, 8, 1}));
    rows.push_back(makeRow(cloud, "grid", {6, 0, 10, 4}));
  }
  return rows;
}

std::string tableOf(const std::vector<EvaluationRow>& rows) {
  std::ostringstream text;
  printTable(text, rows);
  return text.str();
}

std::string tableOneOf(const std::vector<EvaluationRow>& rows) {
  const std::string table = tableOf(rows);
  const std::size_t begin = table.find("as the paper's Table I");
  return begin == std::string::npos ? "" : table.substr(begin);
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// How often a text occurs in another.
int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(EvaluationTable, SetsSeveralCloudsSideBySideAsThePaper) {
  const std::vector<std::string> lines = linesOf(tableOneOf(rowsOf({"x/a.pcd", "x/b.pcd"})));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_LT(lines[1].find("a.pcd"), lines[1].find("b.pcd"));
  EXPECT_LT(lines[1].find("b.pcd"), lines[1].find("mean of 2 clouds"));
  EXPECT_EQ(occurrences(lines[2], "TPR"), 3);
  EXPECT_EQ(occurrences(lines[3], " 0.900 0.800 0.857"), 3);
  EXPECT_EQ(occurrences(lines[4], " 0.600 1.000 0.750"), 3);
}

TEST(EvaluationTable, OneCloudNeedsNoMeanAndNoTableOne) {
  const std::string table = tableOf(rowsOf({"a.pcd"}));
  EXPECT_EQ(table.find("mean"), std::string::npos);
  EXPECT_EQ(tableOneOf(rowsOf({"a.pcd"})), "");
}

TEST(EvaluationTable, ContinuesBelowWhereThePageIsFull) {
  for (const std::size_t count : {4u, 5u, 8u, 11u}) {
    SCOPED_TRACE(count);
    std::vector<std::string> clouds;
    for (std::size_t n = 0; n < count; ++n)
      clouds.push_back("a_rather_long_name_of_a_cloud_" + std::to_string(n));
    const std::string table = tableOneOf(rowsOf(clouds));
    EXPECT_EQ(occurrences(table, "_cloud_"), static_cast<int>(count));
    EXPECT_EQ(occurrences(table, "mean of"), 1);
    EXPECT_EQ(occurrences(table, " 0.900 0.800 0.857"), static_cast<int>(count) + 1);
    for (const std::string& line : linesOf(tableOf(rowsOf(clouds)))) EXPECT_LE(line.size(), 132u) << line;
  }
}

TEST(EvaluationTable, LongNamesOfMethodsFit) {
  std::vector<EvaluationRow> rows;
  for (const std::string cloud : {"a.pcd", "b.pcd", "c.pcd", "d.pcd"})
    rows.push_back(makeRow(cloud, "pcl-approximate-pmf", {9, 2, 8, 1}));
  const std::string table = tableOf(rows);
  EXPECT_EQ(occurrences(table, "  pcl-approximate-pmf "), 4 + 1 + 1);
  for (const std::string& line : linesOf(table)) EXPECT_LE(line.size(), 132u) << line;
}

TEST(EvaluationTable, CloudsOfOneNameHaveTheirPathsAsTitles) {
  const std::string table = tableOf(rowsOf({"one/scan.pcd", "two/scan.pcd", "two/other.pcd"}));
  EXPECT_NE(table.find("one/scan.pcd\n"), std::string::npos);
  EXPECT_NE(table.find("two/scan.pcd\n"), std::string::npos);
  EXPECT_NE(table.find("\nother.pcd\n"), std::string::npos);
}

TEST(EvaluationTable, AFailureHasItsReasonAndIsNoPartOfTheMean) {
  std::vector<EvaluationRow> rows = rowsOf({"a.pcd", "b.pcd"});
  rows[0] = makeRow("a.pcd", "naive", {});
  rows[0].failure = "use larger cells";
  EXPECT_NE(tableOf(rows).find("naive         use larger cells\n"), std::string::npos) << tableOf(rows);
  const std::vector<std::string> lines = linesOf(tableOneOf(rows));
  EXPECT_EQ(occurrences(lines[3], "-"), 3);
  EXPECT_EQ(occurrences(lines[3], " 0.900 0.800 0.857"), 2);
}

TEST(EvaluationFiles, QuoteTheNamesOfClouds) {
  const std::string csv = asCsv(rowsOf({"a \"b\", c.pcd"}));
  EXPECT_NE(csv.find("\n\"a \"\"b\"\", c.pcd\",naive,9,2,8,1,0.9,0.8,"), std::string::npos) << csv;
}

TEST(EvaluationFiles, WhatARowDoesNotHaveIsNullOrEmpty) {
  std::vector<EvaluationRow> rows{makeRow("a.pcd", "naive", {0, 0, 10, 0})};
  EXPECT_TRUE(asJson(rows)["results"][0]["surface_rmse"].is_number_float());
  EXPECT_EQ(asJson(rows).dump().find("nan"), std::string::npos);
  EXPECT_NE(asCsv(rows).find(",0,0,10,0,,1,"), std::string::npos) << asCsv(rows);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
