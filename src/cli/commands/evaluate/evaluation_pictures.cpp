#include "commands/evaluate/evaluation_pictures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "pictures/map_sheet.h"
#include "pictures/top_view.h"

namespace pcl_fft_ground::cli {
namespace {

/// What became of a point. Where two are equally frequent in a cell, the later one is shown: errors first.
enum Kind { TRUE_GROUND, IGNORED, TRUE_OBJECT, FALSE_OBJECT, MISSED_OBJECT, KIND_COUNT };

const std::array<LegendEntry, KIND_COUNT> kKinds{{{{0.74, 0.74, 0.74}, "true ground"},
                                                  {{0.98, 0.93, 0.66}, "ignored"},
                                                  {{0.20, 0.42, 0.86}, "true object"},
                                                  {{0.95, 0.52, 0.10}, "false object"},
                                                  {{0.55, 0.02, 0.35}, "missed object"}}};

/// Cells along the longer side of a map.
constexpr Eigen::Index kCells = 380;

bool isScored(int truth) {
  return truth == 0 || truth == 1;
}

int kindOf(int truth, core::Label label) {
  if (!isScored(truth) || label == core::Label::NEITHER) return IGNORED;
  const bool is_object = label == core::Label::OBJECT;
  if (truth == 1) return is_object ? TRUE_OBJECT : MISSED_OBJECT;
  return is_object ? FALSE_OBJECT : TRUE_GROUND;
}

std::vector<int> kindsOf(const std::vector<int>& truth, const core::Labels& labels) {
  std::vector<int> kinds(truth.size());
  std::transform(truth.begin(), truth.end(), labels.begin(), kinds.begin(), kindOf);
  return kinds;
}

/// The truth as labels, as if a method had found it.
core::Labels asLabels(const std::vector<int>& truth) {
  core::Labels labels(truth.size());
  std::transform(truth.begin(), truth.end(), labels.begin(),
                 [](int value) { return isScored(value) ? core::Label(value) : core::Label::NEITHER; });
  return labels;
}

std::string hexColour(const Colour& colour) {
  char text[8] = "";
  const auto part = [](double share) { return static_cast<unsigned>(std::lround(255 * share)); };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", part(colour.red), part(colour.green), part(colour.blue));
  return text;
}

std::string percent(double share) {
  return std::isfinite(share) ? fixedNumber(100.0 * share, 1) + " %" : "-";
}

std::string describeTruth(const std::vector<int>& truth) {
  const auto count = [&](int label) {
    return static_cast<double>(std::count(truth.begin(), truth.end(), label));
  };
  const double scored = count(0) + count(1);
  const auto all = static_cast<double>(truth.size());
  return percent(count(1) / scored) + " of the scored points are objects, " + percent(1.0 - scored / all) +
         " ignored";
}

std::string describeScores(const core::Confusion& confusion) {
  const auto rate = [](double value) { return std::isfinite(value) ? fixedNumber(value, 3) : "-"; };
  return "TPR " + rate(confusion.truePositiveRate()) + "   TNR " + rate(confusion.trueNegativeRate()) +
         "   F1 " + rate(confusion.f1());
}

}  // namespace

std::vector<std::string> pictureNames(const std::vector<std::string>& clouds) {
  std::vector<std::string> names;
  for (const std::string& cloud : clouds) {
    const std::string stem = std::filesystem::path(cloud).stem().string();
    std::string name = stem + ".png";
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n)
      name = stem + "_" + std::to_string(n) + ".png";
    names.push_back(name);
  }
  return names;
}

void drawEvaluations(const std::filesystem::path& path, const LabelledCloud& cloud, const Eigen::Vector3d& up,
                     const std::vector<Evaluation>& evaluations) {
  const std::vector<int>& truth = cloud.cloud.labels;
  const TopView view = viewFromAbove(*cloud.cloud.points, up, kCells);
  const std::vector<LegendEntry> legend(kKinds.begin(), kKinds.end());
  MapSheet sheet(std::filesystem::path(cloud.path).filename().string(), view,
                 1 + static_cast<int>(evaluations.size()));
  const auto draw = [&](const std::string& name, const std::string& remark, const core::Labels& labels) {
    sheet.drawMap(name, remark, classesFromAbove(view, kindsOf(truth, labels), KIND_COUNT), legend);
  };
  draw("truth", describeTruth(truth), asLabels(truth));
  for (const auto& [row, labels] : evaluations) {
    if (row.failure.empty())
      draw(row.method, describeScores(row.confusion), labels);
    else
      sheet.leaveEmpty(row.method, row.failure, "no result");
  }
  std::vector<LegendEntry> key = legend;
  key.push_back({{1.0, 1.0, 1.0}, "no points"});
  sheet.write(path, key);
}

std::vector<ViewLayer> evaluationLayers(const LabelledCloud& cloud, const Eigen::Vector3d& up,
                                        const Evaluation& evaluation) {
  if (!evaluation.row.failure.empty()) return {};
  std::vector<ViewLayer> layers;
  for (const LegendEntry& kind : kKinds) layers.push_back({kind.text, hexColour(kind.colour), {}, {}});
  const std::vector<int> kinds = kindsOf(cloud.cloud.labels, evaluation.labels);
  const Eigen::Matrix3f level =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix().cast<float>();
  for (const std::size_t n : thinnedIndices(kinds.size(), MOST_VIEW_POINTS))
    layers[static_cast<std::size_t>(kinds[n])].points.emplace_back(level *
                                                                   (*cloud.cloud.points)[n].getVector3fMap());
  return layers;
}

}  // namespace pcl_fft_ground::cli
