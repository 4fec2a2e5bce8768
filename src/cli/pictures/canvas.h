#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pictures/colour_map.h"

// Cairo's own names for what cairo.h calls cairo_t and cairo_surface_t: users of this header need not have
// it.
struct _cairo;
struct _cairo_surface;

namespace pcl_fft_ground::cli {

/// An axis-parallel rectangle on the page [pixels], x to the right, y down.
struct Rectangle {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

/// A line's colour, its width [pixels] and, where `dash` is positive, the length of its dashes and gaps
/// [pixels].
struct Stroke {
  Colour colour;
  double width = 1.0;
  double dash = 0.0;
};

/// Which part of a text is at the given position, along its direction of writing.
enum class Anchor { START, MIDDLE, END };

enum class Weight { NORMAL, BOLD };

/// Look of a text: size [pixels], anchor, colour, weight, direction, and a halo that keeps it legible on
/// pictures.
struct TextStyle {
  double size = 13.0;
  Anchor anchor = Anchor::MIDDLE;
  Colour colour = {0.1, 0.1, 0.1};
  Weight weight = Weight::NORMAL;
  double angle = 0.0;      ///< [rad], anti-clockwise
  double halo = 0.0;       ///< width of a white border around the letters [pixels], 0 for none
  double max_width = 0.0;  ///< the text shrinks to fit this [pixels], 0 for no limit
};

/// Colours as 0xffRRGGBB, x along rows and y, upwards, along columns (as elevation grids are).
using Pixels = Eigen::Array<std::uint32_t, Eigen::Dynamic, Eigen::Dynamic>;

/// A white page to draw on, written as PNG in the end. Positions are pixels from the top left corner.
class Canvas {
 public:
  /// A page of this many pixels. Throws WorkError where there is no memory for it.
  Canvas(int width, int height);

  void fill(const Rectangle& area, const Colour& colour);
  void outline(const Rectangle& area, const Stroke& stroke);
  void polygon(const std::vector<Eigen::Vector2d>& corners, const Colour& colour);
  /// Connects the points, leaving a gap at non-finite ones. Nothing outside `area` is drawn.
  void polyline(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke, const Rectangle& area);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Stroke& stroke);
  /// A five-pointed star with a white rim.
  void star(const Eigen::Vector2d& centre, double radius, const Colour& colour);
  /// Stretches an image over the area, each pixel of it a plain rectangle.
  void image(const Rectangle& area, const Pixels& pixels);

  /// Writes a text, its middle height at `position`. Bytes that are not UTF-8 appear as '?'; without any font
  /// the text is left out or drawn with Cairo's built-in strokes.
  void text(const Eigen::Vector2d& position, const std::string& text, const TextStyle& style = {});
  /// Width of a text [pixels]; 0 where it cannot be measured.
  double textWidth(const std::string& text, const TextStyle& style = {}) const;

  int width() const;
  int height() const;

  /// Writes exactly this file. Throws WorkError, naming it, where that fails.
  void write(const std::filesystem::path& path);

 private:
  struct Release {
    void operator()(_cairo_surface* surface) const;
    void operator()(_cairo* context) const;
  };
  using Surface = std::unique_ptr<_cairo_surface, Release>;
  using Context = std::unique_ptr<_cairo, Release>;

  Context textContext(const TextStyle& style) const;
  void setStroke(const Stroke& stroke);
  void setSource(const Colour& colour);

  Surface surface_;
  Context context_;
};

}  // namespace pcl_fft_ground::cli
