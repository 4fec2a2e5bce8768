#include "pictures/canvas.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Lines one pixel wide are sharp when they run through the middle of pixels.
double sharp(double position) {
  return std::floor(position) + 0.5;
}

std::string asciiOnly(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 128; }, '?');
  return text;
}

/// The extents of a text; all zero where Cairo cannot measure it.
cairo_text_extents_t extentsOf(cairo_t* context, const std::string& text) {
  cairo_text_extents_t extents{};
  cairo_text_extents(context, text.c_str(), &extents);
  return cairo_status(context) == CAIRO_STATUS_SUCCESS ? extents : cairo_text_extents_t{};
}

double anchorShare(Anchor anchor) {
  return anchor == Anchor::START ? 0.0 : anchor == Anchor::MIDDLE ? 0.5 : 1.0;
}

/// A white border around the letters of a text that starts at `start`.
void drawHalo(cairo_t* context, const Eigen::Vector2d& start, const std::string& text, double width) {
  cairo_move_to(context, start.x(), start.y());
  cairo_text_path(context, text.c_str());
  cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
  cairo_set_line_width(context, 2.0 * width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(context);
}

}  // namespace

void Canvas::Release::operator()(cairo_surface_t* surface) const {
  cairo_surface_destroy(surface);
}
void Canvas::Release::operator()(cairo_t* context) const {
  cairo_destroy(context);
}

Canvas::Canvas(int width, int height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      context_(cairo_create(surface_.get())) {
  if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS)
    throw WorkError("no picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels: " + cairo_status_to_string(cairo_status(context_.get())));
  fill({0.0, 0.0, static_cast<double>(width), static_cast<double>(height)}, {1.0, 1.0, 1.0});
}

int Canvas::width() const {
  return cairo_image_surface_get_width(surface_.get());
}
int Canvas::height() const {
  return cairo_image_surface_get_height(surface_.get());
}

void Canvas::setSource(const Colour& colour) {
  cairo_set_source_rgb(context_.get(), colour.red, colour.green, colour.blue);
}

void Canvas::setStroke(const Stroke& stroke) {
  setSource(stroke.colour);
  cairo_set_line_width(context_.get(), stroke.width);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(context_.get(), &stroke.dash, stroke.dash > 0.0 ? 1 : 0, 0.0);
}

void Canvas::fill(const Rectangle& area, const Colour& colour) {
  setSource(colour);
  cairo_rectangle(context_.get(), area.x, area.y, area.width, area.height);
  cairo_fill(context_.get());
}

void Canvas::outline(const Rectangle& area, const Stroke& stroke) {
  setStroke(stroke);
  // Around the area, not over it: its outermost pixels stay visible.
  const Eigen::Vector2d corner(sharp(area.x) - 1.0, sharp(area.y) - 1.0);
  cairo_rectangle(context_.get(), corner.x(), corner.y(), sharp(area.right()) - corner.x(),
                  sharp(area.bottom()) - corner.y());
  cairo_stroke(context_.get());
}

void Canvas::polygon(const std::vector<Eigen::Vector2d>& corners, const Colour& colour) {
  setSource(colour);
  for (const Eigen::Vector2d& corner : corners) cairo_line_to(context_.get(), corner.x(), corner.y());
  cairo_close_path(context_.get());
  cairo_fill(context_.get());
}

void Canvas::polyline(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke,
                      const Rectangle& area) {
  cairo_save(context_.get());
  cairo_rectangle(context_.get(), area.x, area.y, area.width, area.height);
  cairo_clip(context_.get());
  setStroke(stroke);
  for (const Eigen::Vector2d& point : points) {
    if (point.allFinite())
      cairo_line_to(context_.get(), point.x(), point.y());
    else
      cairo_new_sub_path(context_.get());
  }
  cairo_stroke(context_.get());
  cairo_restore(context_.get());
}

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Stroke& stroke) {
  setStroke(stroke);
  cairo_move_to(context_.get(), sharp(from.x()), sharp(from.y()));
  cairo_line_to(context_.get(), sharp(to.x()), sharp(to.y()));
  cairo_stroke(context_.get());
}

void Canvas::star(const Eigen::Vector2d& centre, double radius, const Colour& colour) {
  for (int corner = 0; corner < 10; ++corner) {
    const double length = corner % 2 == 0 ? radius : 0.42 * radius;
    const double angle = kPi * corner / 5.0;
    cairo_line_to(context_.get(), centre.x() + length * std::sin(angle),
                  centre.y() - length * std::cos(angle));
  }
  cairo_close_path(context_.get());
  setStroke({{1.0, 1.0, 1.0}, 2.0});
  cairo_stroke_preserve(context_.get());
  setSource(colour);
  cairo_fill(context_.get());
}

void Canvas::image(const Rectangle& area, const Pixels& pixels) {
  if (pixels.size() == 0) return;
  const auto width = static_cast<int>(pixels.rows());
  const auto height = static_cast<int>(pixels.cols());
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw WorkError("no memory for a picture");
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int row = 0; row < height; ++row)  // y points up in the grid, down in the image
    std::memcpy(data + static_cast<std::ptrdiff_t>(row) * stride, pixels.col(height - 1 - row).data(),
                static_cast<std::size_t>(width) * sizeof(std::uint32_t));
  cairo_surface_mark_dirty(surface.get());

  cairo_save(context_.get());
  cairo_translate(context_.get(), area.x, area.y);
  cairo_scale(context_.get(), area.width / width, area.height / height);
  cairo_set_source_surface(context_.get(), surface.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context_.get()), CAIRO_FILTER_NEAREST);
  cairo_rectangle(context_.get(), 0.0, 0.0, width, height);
  cairo_fill(context_.get());
  cairo_restore(context_.get());
}

/// A context of its own for each text: an error in it, such as a broken font, cannot spoil the rest of the
/// page.
Canvas::Context Canvas::textContext(const TextStyle& style) const {
  Context context(cairo_create(surface_.get()));
  cairo_select_font_face(context.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.weight == Weight::BOLD ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context.get(), style.size);
  return context;
}

double Canvas::textWidth(const std::string& text, const TextStyle& style) const {
  const double width = extentsOf(textContext(style).get(), text).x_advance;
  return width > 0.0 ? width : extentsOf(textContext(style).get(), asciiOnly(text)).x_advance;
}

void Canvas::text(const Eigen::Vector2d& position, const std::string& text, const TextStyle& style) {
  TextStyle fitting = style;
  const double wanted = textWidth(text, style);
  if (style.max_width > 0.0 && wanted > style.max_width) fitting.size *= style.max_width / wanted;
  const double width = textWidth(text, fitting);

  const auto write = [&](const std::string& shown) {
    const Context context = textContext(fitting);
    const Eigen::Vector2d start(-anchorShare(fitting.anchor) * width, 0.36 * fitting.size);
    cairo_translate(context.get(), position.x(), position.y());
    cairo_rotate(context.get(), -fitting.angle);
    if (fitting.halo > 0.0) drawHalo(context.get(), start, shown, fitting.halo);
    cairo_set_source_rgb(context.get(), fitting.colour.red, fitting.colour.green, fitting.colour.blue);
    cairo_move_to(context.get(), start.x(), start.y());
    cairo_show_text(context.get(), shown.c_str());
    return cairo_status(context.get()) == CAIRO_STATUS_SUCCESS;
  };
  if (!write(text)) write(asciiOnly(text));
}

void Canvas::write(const std::filesystem::path& path) {
  cairo_surface_flush(surface_.get());
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), path.c_str());
  if (status != CAIRO_STATUS_SUCCESS)
    throw WorkError("cannot write picture '" + path.string() + "': " + cairo_status_to_string(status));
}

}  // namespace pcl_fft_ground::cli
