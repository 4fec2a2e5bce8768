#include "pictures/map_sheet.h"

#include <algorithm>
#include <cmath>

namespace pcl_fft_ground::cli {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kSide = 380.0;     // of a square map; others have about its area
constexpr double kLongest = 800.0;  // side of a map
constexpr double kShortest = 4.0;
constexpr double kLeft = 70.0;  // around each map: y axis,
constexpr double kRight = 16.0;
constexpr double kAbove = 50.0;  // name and remark,
constexpr double kBelow = 52.0;  // x axis
constexpr double kTitle = 48.0;  // around all maps: title
constexpr double kLegend = 44.0;
constexpr double kNarrowest = 600.0;  // page width that title and legend need
constexpr double kProportions = 1.6;  // of a page, as a screen has them
const Colour kInk = {0.1, 0.1, 0.1};

Vector2d cellsOf(const GridImage& image) {
  return {static_cast<double>(std::max<Index>(image.values.rows(), 1)),
          static_cast<double>(std::max<Index>(image.values.cols(), 1))};
}

}  // namespace

Vector2d MapSheet::Layout::place() const {
  return map + Vector2d(kLeft + kRight, kAbove + kBelow);
}

Vector2d MapSheet::Layout::page() const {
  const Vector2d all = place().cwiseProduct(Vector2d(columns, rows));
  return {std::max(all.x(), kNarrowest), all.y() + kTitle + kLegend};
}

Rectangle MapSheet::Layout::area(int n) const {
  const Vector2d corner = place().cwiseProduct(Vector2d(n % columns, n / columns));
  const double left = std::floor(0.5 * (page().x() - columns * place().x()));
  return {left + corner.x() + kLeft, corner.y() + kTitle + kAbove, map.x(), map.y()};
}

MapSheet::Layout MapSheet::layOut(const GridImage& image, int maps) {
  const Vector2d cells = cellsOf(image);
  const double scale = std::min(kSide / std::sqrt(cells.prod()), kLongest / cells.maxCoeff());
  const Vector2d map = (scale * cells).cwiseMax(kShortest).array().round();
  const auto misfit = [](const Layout& layout) {
    return std::abs(std::log(layout.page().x() / layout.page().y() / kProportions));
  };
  Layout best{map, 1, maps};
  for (int columns = 2; columns <= maps; ++columns) {
    const Layout layout{map, columns, (maps + columns - 1) / columns};
    if (misfit(layout) < misfit(best)) best = layout;
  }
  return best;
}

MapSheet::MapSheet(const std::string& title, const TopView& view, int maps)
    : view_(view),
      light_(hillShade(view.top.values, Vector2d::Constant(view.top.cell_size))),
      layout_(layOut(view.top, maps)),
      canvas_(static_cast<int>(layout_.page().x()), static_cast<int>(layout_.page().y())) {
  TextStyle style{18.0, Anchor::MIDDLE, kInk, Weight::BOLD};
  style.max_width = layout_.page().x() - 30.0;
  canvas_.text({0.5 * layout_.page().x(), 28.0}, title, style);
}

Plot MapSheet::beginMap(const std::string& name, const std::string& remark) {
  const Rectangle area = layout_.area(drawn_++);
  const double middle = area.x + 0.5 * area.width;
  TextStyle style{15.0, Anchor::MIDDLE, kInk, Weight::BOLD};
  style.max_width = layout_.place().x() - 10.0;
  canvas_.text({middle, area.y - 32.0}, name, style);
  style.size = 13.0;
  style.weight = Weight::NORMAL;
  canvas_.text({middle, area.y - 12.0}, remark, style);
  const Vector2d low = view_.top.origin, high = low + view_.top.cell_size * cellsOf(view_.top);
  return {area, {low.x(), high.x()}, {low.y(), high.y()}};
}

void MapSheet::drawAxes(const Plot& plot) {
  drawFrame(canvas_, plot);
  drawLowerAxis(canvas_, plot, ticksFor(plot.x, plot.area.width, 70.0), "x [m]");
  drawLeftAxis(canvas_, plot, ticksFor(plot.y, plot.area.height, 50.0), "y [m]");
}

void MapSheet::drawMap(const std::string& name, const std::string& remark, const Eigen::ArrayXXi& classes,
                       const std::vector<LegendEntry>& legend) {
  const Plot plot = beginMap(name, remark);
  const auto colour = [&](int kind) { return legend[static_cast<std::size_t>(kind)].colour; };
  canvas_.image(plot.area, shadedClasses(classes, light_, colour));
  drawAxes(plot);
}

void MapSheet::leaveEmpty(const std::string& name, const std::string& remark, const std::string& word) {
  const Plot plot = beginMap(name, remark);
  writeInMiddle(canvas_, plot, word);
  drawAxes(plot);
}

void MapSheet::write(const std::filesystem::path& path, const std::vector<LegendEntry>& legend) {
  drawLegend(canvas_, layout_.page().y() - 30.0, legend);
  canvas_.write(path);
}

}  // namespace pcl_fft_ground::cli
