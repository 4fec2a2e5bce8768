#include "commands/align/align_report.h"

#include <algorithm>
#include <cmath>

#include "pictures/axes.h"
#include "pictures/canvas.h"
#include "pictures/colour_map.h"
#include "pictures/map_page.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double LONGEST = 620.0;  // side of a panel [pixels]
constexpr double LEFT = 80.0, TOP = 60.0, GAP = 90.0, BELOW = 100.0, RIGHT = 30.0;

// What lies over a cell of the picture; more than one thing may.
enum Content : int { REFERENCE = 1, MOVING = 2, REFERENCE_SEGMENT = 4, MOVING_SEGMENT = 8, MATCHED = 16 };

const Colour NAVY = {0.30, 0.40, 0.85}, RED = {0.88, 0.36, 0.33}, PURPLE = {0.58, 0.38, 0.60};
const Colour TURQUOISE = {0.25, 0.88, 0.82}, YELLOW = {1.0, 0.88, 0.20}, GREEN = {0.62, 0.88, 0.42};
const Colour BLACK = {0.0, 0.0, 0.0};

Colour colourOf(int content) {
  const int segments = content & (REFERENCE_SEGMENT | MOVING_SEGMENT);
  if ((content & MATCHED) != 0) return BLACK;
  if (segments == (REFERENCE_SEGMENT | MOVING_SEGMENT)) return GREEN;
  if (segments != 0) return segments == MOVING_SEGMENT ? YELLOW : TURQUOISE;
  if (content == (REFERENCE | MOVING)) return PURPLE;
  return content == MOVING ? RED : NAVY;
}

/// The rectangle of the reference's x and y axes that holds both scans, before and after.
Eigen::AlignedBox2d extentOf(const PairImage& image) {
  Eigen::AlignedBox2d extent;
  const auto extend = [&](const core::Points& points, const Eigen::Isometry3d& pose) {
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      extent.extend((pose * points.col(n).cast<double>()).head<2>());
  };
  extend(image.reference.surface, Eigen::Isometry3d::Identity());
  extend(image.moving.surface, image.before);
  extend(image.moving.surface, image.after);
  // Mean points of objects alone may lie a voxel beyond those of all points.
  const Eigen::Vector2d margin =
      Eigen::Vector2d::Constant(2 * std::max(image.reference.voxel_size, image.moving.voxel_size));
  return {extent.min() - margin, extent.max() + margin};
}

/// The cells of one panel.
class Panel {
 public:
  Panel(const Eigen::AlignedBox2d& extent, double cell_size)
      : origin_(extent.min()),
        cell_size_(cell_size),
        contents_(Eigen::ArrayXXi::Zero(static_cast<Eigen::Index>(extent.sizes().x() / cell_size) + 1,
                                        static_cast<Eigen::Index>(extent.sizes().y() / cell_size) + 1)) {}

  void mark(const core::Points& points, const Eigen::Isometry3d& pose, int content) {
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Vector2d place = (pose * points.col(n).cast<double>()).head<2>();
      const Eigen::Array2d cell = ((place - origin_) / cell_size_).array();
      contents_(static_cast<Eigen::Index>(cell.x()), static_cast<Eigen::Index>(cell.y())) |= content;
    }
  }

  Pixels pixels() const {
    return contents_.unaryExpr([](int content) {
      return packed(content == 0 ? Colour{1, 1, 1} : colourOf(content));
    });
  }

 private:
  Eigen::Vector2d origin_;
  double cell_size_;
  Eigen::ArrayXXi contents_;
};

void markScan(Panel& panel, const core::ScanSegments& scan, const Eigen::Isometry3d& pose, int ground,
              int segment) {
  panel.mark(scan.surface, pose, ground);
  for (const core::Segment& s : scan.segments) panel.mark(s.points, pose, segment);
}

Panel makePanel(const PairImage& image, const Eigen::AlignedBox2d& extent, const Eigen::Isometry3d& pose,
                const std::vector<core::SegmentMatch>& matches) {
  constexpr double MOST_CELLS = 2000;  // along a side; scans far apart are drawn more coarsely
  Panel panel(extent, std::max({image.reference.voxel_size, image.moving.voxel_size,
                                extent.sizes().maxCoeff() / MOST_CELLS}));
  markScan(panel, image.reference, Eigen::Isometry3d::Identity(), REFERENCE, REFERENCE_SEGMENT);
  markScan(panel, image.moving, pose, MOVING, MOVING_SEGMENT);
  for (const core::SegmentMatch& match : matches) {
    panel.mark(image.reference.segments[match.reference].points, Eigen::Isometry3d::Identity(), MATCHED);
    panel.mark(image.moving.segments[match.moving].points, pose, MATCHED);
  }
  return panel;
}

void drawPanel(Canvas& canvas, const Plot& plot, const Panel& panel, const std::string& title) {
  canvas.image(plot.area, panel.pixels());
  drawFrame(canvas, plot);
  drawLowerAxis(canvas, plot, ticksFor(plot.x, plot.area.width, 90.0), "x of the reference [m]");
  drawLeftAxis(canvas, plot, ticksFor(plot.y, plot.area.height, 55.0), "y of the reference [m]");
  TextStyle style{16.0, Anchor::MIDDLE, {0.15, 0.15, 0.15}, Weight::BOLD};
  style.max_width = std::max(plot.area.width + 60.0, 400.0);
  canvas.text({plot.area.x + 0.5 * plot.area.width, plot.area.y - 18.0}, title, style);
}

}  // namespace

void drawAlignment(const std::filesystem::path& path, const PairImage& image) {
  const Eigen::AlignedBox2d extent = extentOf(image);
  const Eigen::Vector2d size = LONGEST / std::max(extent.sizes().maxCoeff(), 1e-3) * extent.sizes();
  const double width = std::max(40.0, std::round(size.x())), height = std::max(40.0, std::round(size.y()));
  const bool stacked = width > 1.5 * height;
  const Eigen::Vector2d step =
      stacked ? Eigen::Vector2d(0.0, height + GAP) : Eigen::Vector2d(width + GAP, 0.0);
  Canvas canvas(static_cast<int>(LEFT + width + step.x() + RIGHT),
                static_cast<int>(TOP + height + step.y() + BELOW));
  const Axis x{extent.min().x(), extent.max().x()}, y{extent.min().y(), extent.max().y()};
  const Plot first{{LEFT, TOP, width, height}, x, y};
  const Plot second{{LEFT + step.x(), TOP + step.y(), width, height}, x, y};
  drawPanel(canvas, first, makePanel(image, extent, image.before, {}), "Before alignment");
  drawPanel(canvas, second, makePanel(image, extent, image.after, image.matches), image.result);
  drawLegend(canvas, canvas.height() - 32.0,
             {{NAVY, "reference"},
              {TURQUOISE, "its segments"},
              {RED, "moving"},
              {YELLOW, "its segments"},
              {PURPLE, "both"},
              {BLACK, "matched segments"}});
  canvas.write(path);
}

}  // namespace pcl_fft_ground::cli
