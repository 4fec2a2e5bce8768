#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pictures/canvas.h"
#include "pictures/raster.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {

enum class AxisScale { LINEAR, LOGARITHMIC };

/// Values from `low` to `high` (low < high; both positive where logarithmic) along one side of a plot.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  AxisScale scale = AxisScale::LINEAR;

  /// Where a value lies: 0 at the low end, 1 at the high end, beyond them outside.
  double share(double value) const;
};

/// A rectangle of the page with an axis along its lower side and one up its left side.
struct Plot {
  Rectangle area;
  Axis x;
  Axis y;

  /// Position on the page [pixels] of a point given in the units of the axes.
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const;
};

/// A mark on an axis and what is written beside it.
struct Tick {
  double value;
  std::string label;
};

/// Round values (1, 2 or 5 times a power of ten apart) in [low, high]: at most about `most`, but at least
/// one.
std::vector<Tick> linearTicks(double low, double high, double most);
/// The values 1, 2 and 5 times a power of ten in [low, high] (positive); only the powers where there are more
/// than `most`.
std::vector<Tick> logarithmicTicks(double low, double high, double most);

/// Ticks of an axis spaced for readable labels along a side of this length [pixels].
std::vector<Tick> ticksFor(const Axis& axis, double length, double per_tick);

void drawFrame(Canvas& canvas, const Plot& plot);
/// Ticks and title below the plot. Ticks give their own labels, so that another quantity can be shown along
/// the axis.
void drawLowerAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks,
                   const std::string& title);
/// As above, on the plot's upper side.
void drawUpperAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks,
                   const std::string& title);
/// As above, on its left side, the title turned upwards.
void drawLeftAxis(Canvas& canvas, const Plot& plot, const std::vector<Tick>& ticks, const std::string& title);

/// What a colour bar shows: its palette, the values at its ends, a title with the unit, and whether there are
/// values beyond the ends, which it then marks with arrow heads.
struct ColourScale {
  const Palette& palette;
  ValueRange range;
  std::string title;
  bool has_below = false;
  bool has_above = false;

  Colour colour(double value) const;
};

/// A colour bar with ticks and title; upright where the area is taller than wide, else lying.
void drawColourBar(Canvas& canvas, const Rectangle& area, const ColourScale& scale);

}  // namespace pcl_fft_ground::cli
