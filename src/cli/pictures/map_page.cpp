#include "pictures/map_page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl_fft_ground::cli {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kLeft = 108.0;
constexpr double kTop = 56.0;
constexpr double kLongest = 800.0;  // the longest side of a map,
constexpr double kWidest = 1600.0;  // or more, where cells would be smaller than this
constexpr double kTallest = 1100.0;
constexpr double kCell = 3.0;
constexpr double kShortest = 4.0;     // a side shorter than this could not be seen
constexpr double kNarrowest = 560.0;  // page width that titles and legends need
constexpr double kBarBelow = 280.0;   // maps lower than this have the colour bar below, not beside
const Colour kInk = {0.15, 0.15, 0.15};

}  // namespace

MapPage layOutMap(const GridImage& image, MapKey key) {
  const Vector2d cells(static_cast<double>(std::max<Index>(image.values.rows(), 1)),
                       static_cast<double>(std::max<Index>(image.values.cols(), 1)));
  const Vector2d high = image.origin + image.cell_size * cells;
  const double wanted = std::min({kCell, kWidest / cells.x(), kTallest / cells.y()});
  const double scale = std::max(kLongest / cells.maxCoeff(), wanted);  // pixels per cell
  const double width = std::max(kShortest, std::round(scale * cells.x()));
  const double height = std::max(kShortest, std::round(scale * cells.y()));
  const bool bar_beside = key == MapKey::COLOUR_BAR && height >= kBarBelow;

  const double page_width = std::max(kNarrowest, kLeft + width + (bar_beside ? 125.0 : 45.0));
  const double left = kLeft + std::floor(0.5 * (page_width - kLeft - width - (bar_beside ? 125.0 : 45.0)));
  const Rectangle area{left, kTop, width, height};
  MapPage page{{area, {image.origin.x(), high.x()}, {image.origin.y(), high.y()}}, {}, 0, 0, {}};
  const double room_below = bar_beside ? 56.0 : key == MapKey::COLOUR_BAR ? 138.0 : 88.0;
  const double wide = std::max(width, kNarrowest - kLeft - 45.0);
  page.key = bar_beside ? Rectangle{area.right() + 24.0, kTop + 20.0, 18.0, height - 40.0}
                        : Rectangle{std::floor(left + 0.5 * (width - wide)) + 20.0, area.bottom() + 66.0,
                                    wide - 40.0, 16.0};
  page.frame = image.frame;
  page.width = static_cast<int>(page_width);
  page.height = static_cast<int>(kTop + height + room_below);
  return page;
}

Plot mapPlot(const GridImage& image, MapKey key) {
  return layOutMap(image, key).plot;
}

Canvas startMap(const MapPage& page, const std::string& title, const Pixels& map) {
  Canvas canvas(page.width, page.height);
  const Rectangle& area = page.plot.area;
  canvas.image(area, map);
  drawFrame(canvas, page.plot);
  drawLowerAxis(canvas, page.plot, ticksFor(page.plot.x, area.width, 90.0), "x in " + page.frame + " [m]");
  drawLeftAxis(canvas, page.plot, ticksFor(page.plot.y, area.height, 55.0), "y in " + page.frame + " [m]");
  TextStyle style{17.0, Anchor::MIDDLE, kInk, Weight::BOLD};
  style.max_width = page.width - 30.0;
  canvas.text({0.5 * page.width, 28.0}, title, style);
  return canvas;
}

Pixels shadedClasses(const Eigen::ArrayXXi& classes, const Eigen::ArrayXXd& light,
                     const std::function<Colour(int)>& colour_of) {
  constexpr std::uint32_t kNothing = 0xffffffffU;
  Pixels result(classes.rows(), classes.cols());
  for (Index k = 0; k < classes.size(); ++k) {
    const int kind = classes.data()[k];
    result.data()[k] = kind < 0 ? kNothing : packed(shaded(colour_of(kind), light.data()[k]));
  }
  return result;
}

void writeInMiddle(Canvas& canvas, const Plot& plot, const std::string& text) {
  TextStyle style{14.0, Anchor::MIDDLE, {0.4, 0.4, 0.4}};
  style.halo = 3.0;
  canvas.text({plot.area.x + 0.5 * plot.area.width, plot.area.y + 0.5 * plot.area.height}, text, style);
}

void drawLegend(Canvas& canvas, double top, const std::vector<LegendEntry>& entries) {
  constexpr double kSquare = 13.0;
  constexpr double kGap = 26.0;
  TextStyle style{13.0, Anchor::START, kInk};
  const double fixed_width = static_cast<double>(entries.size()) * (kSquare + 7.0 + kGap) - kGap;
  double text_width = 0.0;
  for (const LegendEntry& entry : entries) text_width += canvas.textWidth(entry.text, style);
  const double room = canvas.width() - 20.0 - fixed_width;
  if (text_width > room) style.size *= room / text_width;
  const double width = fixed_width + std::min(text_width, room);
  double x = std::floor(0.5 * (canvas.width() - width));
  for (const LegendEntry& entry : entries) {
    const Rectangle square{x, top, kSquare, kSquare};
    canvas.fill(square, entry.colour);
    canvas.outline(square, {kInk});
    canvas.text({x + kSquare + 7.0, top + 0.5 * kSquare}, entry.text, style);
    x += kSquare + 7.0 + canvas.textWidth(entry.text, style) + kGap;
  }
}

}  // namespace pcl_fft_ground::cli
