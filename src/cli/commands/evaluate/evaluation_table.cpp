#include "commands/evaluate/evaluation_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "printable.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr std::size_t METHOD_WIDTH = 14;  // at least
constexpr std::size_t TABLE_ONE_MEASURES = 3;
constexpr int RATE_WIDTH = 6;        // of a rate in Table I
constexpr int GROUP_GAP = 3;         // between the clouds of Table I
constexpr std::size_t PER_PAGE = 4;  // clouds side by side, as in the paper

/// What a column of Table I or a block of the long table is about: a cloud, or the mean of all.
struct Group {
  std::string title;
  std::string cloud;  ///< empty: the mean
};

std::string fixedText(double value) {
  if (std::isnan(value)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << value;
  return text.str();
}

/// The name of a file, or its whole path where another cloud has the same name.
std::string shortName(const std::string& cloud, const std::vector<std::string>& clouds) {
  const auto nameOf = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  const auto same = [&](const std::string& other) { return nameOf(other) == nameOf(cloud); };
  return std::count_if(clouds.begin(), clouds.end(), same) > 1 ? cloud : nameOf(cloud);
}

std::vector<Group> groupsOf(const std::vector<EvaluationRow>& rows) {
  const std::vector<std::string> clouds = distinct(rows, &EvaluationRow::cloud);
  std::vector<Group> groups;
  for (const std::string& cloud : clouds) groups.push_back({shortName(cloud, clouds), cloud});
  if (clouds.size() > 1) groups.push_back({"mean of " + std::to_string(clouds.size()) + " clouds", ""});
  return groups;
}

/// The row of a method on a cloud; there is one for each pair.
const EvaluationRow& rowOf(const std::vector<EvaluationRow>& rows, const std::string& method,
                           const std::string& cloud) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const EvaluationRow& row) { return row.method == method && row.cloud == cloud; });
}

double valueOf(const std::vector<EvaluationRow>& rows, const std::string& method, const Group& group,
               const Measure& measure) {
  return group.cloud.empty() ? meanOf(rows, method, measure) : measure.of(rowOf(rows, method, group.cloud));
}

int methodWidthOf(const std::vector<EvaluationRow>& rows) {
  std::size_t width = METHOD_WIDTH;
  for (const EvaluationRow& row : rows) width = std::max(width, row.method.size() + 3);
  return static_cast<int>(width);
}

int widthOf(const Measure& measure) {
  constexpr std::size_t NUMBER = 9, GAP = 2;
  return static_cast<int>(std::max(std::string(measure.name).size(), NUMBER) + GAP);
}

std::ostream& startRow(std::ostream& out, int width, const std::string& method) {
  return out << std::left << std::setw(width) << "  " + method << std::right;
}

void printBlock(std::ostream& out, const std::vector<EvaluationRow>& rows, const Group& group) {
  const int method_width = methodWidthOf(rows);
  out << printable(group.title) << '\n';
  startRow(out, method_width, "");
  for (const Measure& measure : measures()) out << std::setw(widthOf(measure)) << measure.name;
  out << '\n';
  for (const std::string& method : distinct(rows, &EvaluationRow::method)) {
    startRow(out, method_width, method);
    const std::string failure = group.cloud.empty() ? "" : rowOf(rows, method, group.cloud).failure;
    if (!failure.empty()) out << "  " << printable(failure);
    for (const Measure& measure : measures())
      if (failure.empty())
        out << std::setw(widthOf(measure)) << fixedText(valueOf(rows, method, group, measure));
    out << '\n';
  }
}

/// Left out the beginning of a title that is too long for its column: names differ at their ends.
std::string shortened(const std::string& title, std::size_t width) {
  if (title.size() <= width) return title;
  std::size_t first = title.size() - width + 2;
  while (first < title.size() && (static_cast<unsigned char>(title[first]) & 0xC0U) == 0x80U) ++first;
  return ".." + title.substr(first);
}

/// The columns of Table I for these groups, side by side.
void printSideBySide(std::ostream& out, const std::vector<EvaluationRow>& rows,
                     const std::vector<Group>& groups) {
  constexpr int WIDTH = TABLE_ONE_MEASURES * RATE_WIDTH;
  const int method_width = methodWidthOf(rows);
  startRow(out, method_width, "");
  for (const Group& group : groups)
    out << std::setw(GROUP_GAP + WIDTH) << printable(shortened(group.title, WIDTH));
  out << '\n';
  startRow(out, method_width, "");
  for (std::size_t n = 0; n < groups.size(); ++n) {
    out << std::setw(GROUP_GAP) << "";
    for (const char* name : {"TPR", "TNR", "F1"}) out << std::setw(RATE_WIDTH) << name;
  }
  out << '\n';
  for (const std::string& method : distinct(rows, &EvaluationRow::method)) {
    startRow(out, method_width, method);
    for (const Group& group : groups) {
      out << std::setw(GROUP_GAP) << "";
      for (std::size_t n = 0; n < TABLE_ONE_MEASURES; ++n)
        out << std::setw(RATE_WIDTH) << fixedText(valueOf(rows, method, group, measures()[n]));
    }
    out << '\n';
  }
}

}  // namespace

void printTable(std::ostream& out, const std::vector<EvaluationRow>& rows) {
  const std::vector<Group> groups = groupsOf(rows);
  for (const Group& group : groups) printBlock(out, rows, group);
  if (groups.size() == 1) return;
  out << "\nas the paper's Table I\n";
  const std::size_t pages = (groups.size() - 2) / PER_PAGE + 1;  // the mean fits beside the last clouds
  for (std::size_t page = 0; page < pages; ++page) {
    const auto first = groups.begin() + static_cast<std::ptrdiff_t>(page * PER_PAGE);
    const auto last = page + 1 == pages ? groups.end() : first + PER_PAGE;
    printSideBySide(out, rows, {first, last});
  }
}

}  // namespace pcl_fft_ground::cli
