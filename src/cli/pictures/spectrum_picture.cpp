#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "pictures/canvas.h"
#include "pictures/colour_map.h"
#include "pictures/pictures.h"
#include "pictures/spectrum_raster.h"

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kPanelSide = 375.0;
constexpr double kPanelTop = 84.0;
constexpr int kPageWidth = 1000;
constexpr int kPageHeight = 874;
constexpr double kEnlargedBelow = 0.06;  // cut-offs too small to be seen well in the whole plane
constexpr double kEnlargedSpan = 4.0;    // half the width of the enlarged part, in cut-offs
const Colour kInk = {0.15, 0.15, 0.15};
const Colour kMagenta = {1.0, 0.0, 1.0};
const Colour kBefore = {0.16, 0.34, 0.62};
const Colour kAfter = {0.90, 0.50, 0.06};

/// The cut-off's ellipse and the star, on a part of the spectrum.
void markCutoff(Canvas& canvas, const Plot& plot, const SpectrumImage& image, double star_radius) {
  std::vector<Vector2d> ellipse;
  for (int k = 0; k <= 180; ++k)
    ellipse.push_back(
        plot.pixel(image.cutoff * Vector2d(std::cos(kTwoPi * k / 180.0), std::sin(kTwoPi * k / 180.0))));
  canvas.polyline(ellipse, {kMagenta, 1.6}, plot.area);
  if (!image.peak) return;
  const Vector2d peak(ratioOf(image.peak->x(), image.before.rows()),
                      ratioOf(image.peak->y(), image.before.cols()));
  canvas.star(plot.pixel(peak), star_radius, kMagenta);
}

/// A white-rimmed inset in the panel's lower right corner that enlarges the surroundings of a small cut-off.
void drawEnlarged(Canvas& canvas, const Plot& panel, const SpectrumImage& image, const ArrayXXd& magnitudes,
                  double reference, const ColourScale& scale) {
  constexpr double kSide = 150.0;
  const Colour white = {1.0, 1.0, 1.0};
  const double span = kEnlargedSpan * image.cutoff;
  const Plot inset{{panel.area.right() - kSide - 8.0, panel.area.bottom() - kSide - 8.0, kSide, kSide},
                   {-span, span},
                   {-span, span}};
  const Vector2d corner = panel.pixel({-span, span});
  const Vector2d opposite = panel.pixel({span, -span});
  const Rectangle shown{corner.x(), corner.y(), opposite.x() - corner.x(), opposite.y() - corner.y()};
  canvas.polyline({{shown.x, shown.bottom()}, {inset.area.x, inset.area.bottom()}}, {white}, panel.area);
  canvas.polyline({{shown.right(), shown.y}, {inset.area.right(), inset.area.y}}, {white}, panel.area);
  canvas.outline(shown, {white});
  canvas.image(inset.area, spectrumPixels(magnitudes, span, static_cast<Index>(kSide), reference, scale));
  canvas.outline(inset.area, {white, 1.5});
  markCutoff(canvas, inset, image, 8.0);
}

void drawPanel(Canvas& canvas, const SpectrumImage& image, SpectrumPanel which, double reference,
               const ColourScale& scale) {
  const bool is_before = which == SpectrumPanel::BEFORE;
  const ArrayXXd& magnitudes = is_before ? image.before : image.after;
  const Plot panel = spectrumPlot(image, which);
  if (magnitudes.size() > 0) {
    const auto side = static_cast<Index>(panel.area.width);
    canvas.image(panel.area, spectrumPixels(magnitudes, 1.0, side, reference, scale));
    const bool is_small = image.cutoff < kEnlargedBelow;
    markCutoff(canvas, panel, image, is_small ? 5.0 : 8.0);
    if (is_small) drawEnlarged(canvas, panel, image, magnitudes, reference, scale);
  }
  drawFrame(canvas, panel);
  std::vector<Tick> ticks = linearTicks(-1.0, 1.0, 5.0);
  drawLowerAxis(canvas, panel, ticks, "x frequency / Nyquist");
  if (!is_before)
    for (Tick& tick : ticks) tick.label.clear();
  drawLeftAxis(canvas, panel, ticks, is_before ? "y frequency / Nyquist" : "");
  canvas.text({panel.area.x + 0.5 * panel.area.width, panel.area.y - 18.0},
              is_before ? "(a) elevation" : "(b) ground surface", {15.0, Anchor::MIDDLE, kInk});
}

void drawCurve(Canvas& canvas, const Plot& plot, const std::vector<Vector2d>& profile, const Stroke& stroke) {
  std::vector<Vector2d> points;
  for (const Vector2d& point : profile) points.push_back(plot.pixel(point));
  canvas.polyline(points, stroke, plot.area);
}

void drawProfileAxes(Canvas& canvas, const Plot& plot, double cell_size) {
  drawFrame(canvas, plot);
  drawLowerAxis(canvas, plot, ticksFor(plot.x, plot.area.width, 70.0), "radial frequency r / Nyquist");
  drawLeftAxis(canvas, plot, ticksFor(plot.y, plot.area.height, 40.0), "mean power [dB]");
  std::vector<Tick> wavelengths =
      logarithmicTicks(2.0 * cell_size / plot.x.high, 2.0 * cell_size / plot.x.low, plot.area.width / 70.0);
  for (Tick& tick : wavelengths) tick.value = 2.0 * cell_size / tick.value;
  drawUpperAxis(canvas, plot, wavelengths, "wavelength [m]");
}

/// The vertical line at the cut-off with its label, on the side where there is room.
void markCutoffInProfile(Canvas& canvas, const Plot& plot, const SpectrumImage& image) {
  const double x = plot.pixel({image.cutoff, 0.0}).x();
  canvas.polyline({{x, plot.area.y}, {x, plot.area.bottom()}}, {kMagenta, 1.6}, plot.area);
  const std::string text = "f_c = " + fixedNumber(100.0 * image.cutoff, 2) +
                           " %, m_c = " + fixedNumber(image.object_size, image.object_size < 0.1 ? 4 : 2) +
                           " m";
  const bool on_right = plot.x.share(image.cutoff) < 0.7;
  TextStyle style{13.5, on_right ? Anchor::START : Anchor::END, {0.75, 0.0, 0.75}};
  style.halo = 3.0;
  canvas.text({x + (on_right ? 10.0 : -10.0), plot.area.y + 18.0}, text, style);
}

void drawProfile(Canvas& canvas, const SpectrumImage& image, double reference, double floor) {
  Plot plot = spectrumPlot(image, SpectrumPanel::PROFILE);
  plot.y.low = floor;
  for (const Tick& tick : ticksFor(plot.y, plot.area.height, 40.0)) {
    const double y = plot.pixel({1.0, tick.value}).y();
    canvas.line({plot.area.x, y}, {plot.area.right(), y}, {{0.88, 0.88, 0.88}});
  }
  drawCurve(canvas, plot, radialProfile(image.before, plot.x, reference), {kBefore, 2.2});
  drawCurve(canvas, plot, radialProfile(image.after, plot.x, reference), {kAfter, 2.2});
  markCutoffInProfile(canvas, plot, image);
  drawProfileAxes(canvas, plot, image.cell_size);
  const double x = plot.area.x + 16.0;
  const double y = plot.area.bottom() - 40.0;
  const auto entry = [&](double height, const Colour& colour, const std::string& text) {
    canvas.line({x, height}, {x + 28.0, height}, {colour, 2.5});
    canvas.text({x + 36.0, height}, text, {13.0, Anchor::START, kInk});
  };
  entry(y, kBefore, "elevation");
  entry(y + 20.0, kAfter, "ground surface");
}

}  // namespace

Plot spectrumPlot(const SpectrumImage& image, SpectrumPanel panel) {
  const Rectangle first{80.0, kPanelTop, kPanelSide, kPanelSide};
  const Rectangle second{first.right() + 35.0, kPanelTop, kPanelSide, kPanelSide};
  if (panel == SpectrumPanel::BEFORE) return {first, {-1.0, 1.0}, {-1.0, 1.0}};
  if (panel == SpectrumPanel::AFTER) return {second, {-1.0, 1.0}, {-1.0, 1.0}};
  const auto longest = static_cast<double>(std::max<Index>({image.before.rows(), image.before.cols(), 4}));
  const double lowest = 0.8 * (image.cutoff > 0.0 ? std::min(2.0 / longest, image.cutoff) : 2.0 / longest);
  const Rectangle below{80.0, kPanelTop + kPanelSide + 114.0, second.right() - 80.0, 240.0};
  return {below, {lowest, 1.5, AxisScale::LOGARITHMIC}, {-60.0, 5.0}};
}

void drawSpectrum(const std::filesystem::path& path, const SpectrumImage& image) {
  if (image.before.rows() != image.after.rows() || image.before.cols() != image.after.cols())
    throw std::invalid_argument("the spectra before and after must have equal sizes");
  Canvas canvas(kPageWidth, kPageHeight);
  const double reference = referenceOf(image.before);
  const double floor = floorDecibel(image.before, reference);
  const double dc = image.before.size() > 0 ? decibel(image.before(0, 0), reference) : floor;
  const ColourScale scale{spectrumPalette(), {floor, 0.0}, "magnitude [dB]", true, dc > 0.0};
  drawPanel(canvas, image, SpectrumPanel::BEFORE, reference, scale);
  drawPanel(canvas, image, SpectrumPanel::AFTER, reference, scale);
  const Rectangle last = spectrumPlot(image, SpectrumPanel::AFTER).area;
  drawColourBar(canvas, {last.right() + 26.0, last.y + 16.0, 18.0, last.height - 32.0}, scale);
  drawProfile(canvas, image, reference, floor);
  canvas.text({0.5 * kPageWidth, 28.0}, "Spectrum of the elevation grid",
              {17.0, Anchor::MIDDLE, kInk, Weight::BOLD});
  canvas.write(path);
}

}  // namespace pcl_fft_ground::cli
