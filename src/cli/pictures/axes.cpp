#include "pictures/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <sstream>

namespace pcl_fft_ground::cli {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;
constexpr double kTickLength = 5.0;
constexpr double kTickTextSize = 12.5;
constexpr double kTitleTextSize = 14.0;
const Colour kInk = {0.15, 0.15, 0.15};

/// The smallest of 1, 2 and 5 times a power of ten that is not below `step` (positive).
double roundStep(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= step * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

/// Decimals needed to write multiples of this step.
int decimalsOf(double step) {
  return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
}

/// A label of few digits for 1, 2 or 5 times a power of ten.
std::string shortLabel(double value) {
  if (value >= 1e-4 && value < 1e6) return fixedNumber(value, decimalsOf(value));
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

double widestLabel(const Canvas& canvas, const std::vector<Tick>& ticks) {
  double widest = 0.0;
  for (const Tick& tick : ticks) widest = std::max(widest, canvas.textWidth(tick.label, {kTickTextSize}));
  return widest;
}

enum class Side { LOWER, UPPER };

void drawLevelAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks, const std::string& title,
                   Side side) {
  const double edge = side == Side::LOWER ? plot.area.bottom() : plot.area.y - 1.0;
  const double outwards = side == Side::LOWER ? 1.0 : -1.0;
  for (const Tick& tick : ticks) {
    const double x = plot.area.x + plot.x.share(tick.value) * plot.area.width;
    canvas.line({x, edge}, {x, edge + outwards * kTickLength}, {kInk});
    canvas.text({x, edge + outwards * 14.0}, tick.label, {kTickTextSize, Anchor::MIDDLE, kInk});
  }
  const double middle = plot.area.x + 0.5 * plot.area.width;
  canvas.text({middle, edge + outwards * 34.0}, title, {kTitleTextSize, Anchor::MIDDLE, kInk});
}

/// The bar's colours and, where values lie beyond its ends, the arrow heads; `along` is the direction of
/// rising values.
void drawBarBody(Canvas& canvas, const Rectangle& area, const ColourScale& scale, bool upright) {
  const auto count = static_cast<Eigen::Index>(scale.palette.size());
  Pixels pixels(upright ? 1 : count, upright ? count : 1);
  std::transform(scale.palette.begin(), scale.palette.end(), pixels.data(), packed);
  canvas.image(area, pixels);
  canvas.outline(area, {kInk});
  const double head = 0.7 * std::min(area.width, area.height);
  const Eigen::Vector2d across =
      upright ? Eigen::Vector2d(area.width, 0.0) : Eigen::Vector2d(0.0, area.height);
  const auto arrow = [&](const Eigen::Vector2d& corner, const Eigen::Vector2d& outwards,
                         const Colour& colour) {
    const Eigen::Vector2d base = corner + 2.0 * outwards;
    canvas.polygon({base, base + across, base + 0.5 * across + head * outwards}, colour);
  };
  const Eigen::Vector2d rising = upright ? Eigen::Vector2d(0.0, -1.0) : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d low =
      upright ? Eigen::Vector2d(area.x, area.bottom()) : Eigen::Vector2d(area.x, area.y);
  const Eigen::Vector2d high =
      upright ? Eigen::Vector2d(area.x, area.y) : Eigen::Vector2d(area.right(), area.y);
  if (scale.has_below) arrow(low, -rising, scale.palette.front());
  if (scale.has_above) arrow(high, rising, scale.palette.back());
}

}  // namespace

double Axis::share(double value) const {
  return scale == AxisScale::LINEAR ? (value - low) / (high - low)
                                    : std::log(value / low) / std::log(high / low);
}

Eigen::Vector2d Plot::pixel(const Eigen::Vector2d& point) const {
  return {area.x + x.share(point.x()) * area.width, area.bottom() - y.share(point.y()) * area.height};
}

std::vector<Tick> linearTicks(double low, double high, double most) {
  std::vector<Tick> ticks;
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))))
    return ticks;  // no round value fits between
  double step = roundStep((high - low) / std::max(most, 1.0));
  // A short axis may lie between two round values of that step: take finer ones until one falls inside.
  while (std::floor(high / step + 1e-9) < std::ceil(low / step - 1e-9)) step = roundStep(0.4 * step);
  const double last = std::floor(high / step + 1e-9);
  for (double k = std::ceil(low / step - 1e-9); k <= last && ticks.size() < 1000; ++k)
    ticks.push_back({k * step, fixedNumber(k == 0.0 ? 0.0 : k * step, decimalsOf(step))});
  return ticks;
}

std::vector<Tick> logarithmicTicks(double low, double high, double most) {
  if (!(low > 0.0) || !std::isfinite(high)) return {};
  const auto collect = [&](const std::vector<double>& factors) {
    std::vector<Tick> ticks;
    for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10.0)
      for (const double factor : factors)
        if (factor * power >= low * (1.0 - 1e-9) && factor * power <= high * (1.0 + 1e-9))
          ticks.push_back({factor * power, shortLabel(factor * power)});
    return ticks;
  };
  const std::vector<Tick> fine = collect({1.0, 2.0, 5.0});
  return static_cast<double>(fine.size()) <= most ? fine : collect({1.0});
}

std::vector<Tick> ticksFor(const Axis& axis, double length, double per_tick) {
  const double most = length / per_tick;
  std::vector<Tick> ticks = axis.scale == AxisScale::LINEAR ? linearTicks(axis.low, axis.high, most)
                                                            : logarithmicTicks(axis.low, axis.high, most);
  if (most < 1.0 && ticks.size() > 1) ticks.resize(1);  // no room for a second label
  return ticks;
}

void drawFrame(Canvas& canvas, const Plot& plot) {
  canvas.outline(plot.area, {kInk});
}

void drawLowerAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks,
                   const std::string& title) {
  drawLevelAxis(canvas, plot, ticks, title, Side::LOWER);
}

void drawUpperAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks,
                   const std::string& title) {
  drawLevelAxis(canvas, plot, ticks, title, Side::UPPER);
}

void drawLeftAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks,
                  const std::string& title) {
  const double edge = plot.area.x - 1.0;
  for (const Tick& tick : ticks) {
    const double y = plot.area.bottom() - plot.y.share(tick.value) * plot.area.height;
    canvas.line({edge - kTickLength, y}, {edge, y}, {kInk});
    canvas.text({edge - kTickLength - 4.0, y}, tick.label, {kTickTextSize, Anchor::END, kInk});
  }
  const double middle = plot.area.y + 0.5 * plot.area.height;
  const double x = std::max(12.0, edge - kTickLength - 20.0 - widestLabel(canvas, ticks));
  canvas.text({x, middle}, title, {kTitleTextSize, Anchor::MIDDLE, kInk, Weight::NORMAL, kHalfPi});
}

Colour ColourScale::colour(double value) const {
  return colourAt(palette, (value - range.low) / (range.high - range.low));
}

void drawColourBar(Canvas& canvas, const Rectangle& area, const ColourScale& scale) {
  const bool upright = area.height > area.width;
  drawBarBody(canvas, area, scale, upright);
  const Axis axis{scale.range.low, scale.range.high};
  if (!upright) {
    const Plot bar{area, axis, {}};
    drawLowerAxis(canvas, bar, ticksFor(axis, area.width, 80.0), scale.title);
    return;
  }
  const std::vector<Tick> ticks = ticksFor(axis, area.height, 45.0);
  for (const Tick& tick : ticks) {
    const double y = area.bottom() - axis.share(tick.value) * area.height;
    canvas.line({area.right(), y}, {area.right() + kTickLength, y}, {kInk});
    canvas.text({area.right() + kTickLength + 4.0, y}, tick.label, {kTickTextSize, Anchor::START, kInk});
  }
  const double x = area.right() + kTickLength + 20.0 + widestLabel(canvas, ticks);
  canvas.text({x, area.y + 0.5 * area.height}, scale.title,
              {kTitleTextSize, Anchor::MIDDLE, kInk, Weight::NORMAL, kHalfPi});
}

}  // namespace pcl_fft_ground::cli
