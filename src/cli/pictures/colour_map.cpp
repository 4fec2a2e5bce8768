#include "pictures/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_fft_ground::cli {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Lightness [0, 1], chroma and hue [degrees] in OKLab.
struct LightnessChromaHue {
  double lightness;
  double chroma;
  double hue;
};

/// Linear-light sRGB, possibly outside [0, 1]; the matrices are those of the OKLab article.
Colour linearRgb(const LightnessChromaHue& colour) {
  const double a = colour.chroma * std::cos(colour.hue * kPi / 180.0);
  const double b = colour.chroma * std::sin(colour.hue * kPi / 180.0);
  const double l = std::pow(colour.lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(colour.lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(colour.lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool isDisplayable(const Colour& linear) {
  const auto inside = [](double channel) { return channel >= -1e-4 && channel <= 1.0 + 1e-4; };
  return inside(linear.red) && inside(linear.green) && inside(linear.blue);
}

double gammaEncoded(double linear) {
  const double channel = std::clamp(linear, 0.0, 1.0);
  return channel <= 0.0031308 ? 12.92 * channel : 1.055 * std::pow(channel, 1.0 / 2.4) - 0.055;
}

/// The displayable colour of this lightness and hue whose chroma comes nearest to the wanted one.
Colour displayable(LightnessChromaHue wanted) {
  double too_grey = 0.0;
  double too_vivid = wanted.chroma;
  if (!isDisplayable(linearRgb(wanted))) {
    for (int step = 0; step < 24; ++step) {
      wanted.chroma = 0.5 * (too_grey + too_vivid);
      (isDisplayable(linearRgb(wanted)) ? too_grey : too_vivid) = wanted.chroma;
    }
    wanted.chroma = too_grey;
  }
  const Colour linear = linearRgb(wanted);
  return {gammaEncoded(linear.red), gammaEncoded(linear.green), gammaEncoded(linear.blue)};
}

/// Samples a path through OKLab given as a function of the share [0, 1].
template <typename Path>
Palette sampled(const Path& path) {
  Palette palette;
  for (std::size_t k = 0; k < palette.size(); ++k)
    palette[k] = displayable(path(static_cast<double>(k) / static_cast<double>(palette.size() - 1)));
  return palette;
}

double mix(double from, double to, double share) {
  return from + (to - from) * share;
}

}  // namespace

const Palette& heightPalette() {
  static const Palette palette = sampled([](double t) {
    return LightnessChromaHue{mix(0.28, 0.95, t), 0.13, mix(290.0, 100.0, t)};
  });
  return palette;
}

const Palette& spectrumPalette() {
  static const Palette palette = sampled([](double t) {
    // Chroma falls to zero half-way, where the hue changes from blue to cream without passing green or red.
    return LightnessChromaHue{mix(0.12, 0.97, t), 0.20 * std::abs(t - 0.55), t < 0.55 ? 260.0 : 90.0};
  });
  return palette;
}

Colour colourAt(const Palette& palette, double share) {
  const double inside = share > 0.0 ? std::min(share, 1.0) : 0.0;  // NaN is not above 0
  return palette[static_cast<std::size_t>(std::lround(inside * static_cast<double>(palette.size() - 1)))];
}

Colour segmentColour(int segment) {
  constexpr double kGoldenAngle = 137.50776405003785;
  constexpr std::array<double, 3> kLightness = {0.60, 0.76, 0.48};
  const auto level = static_cast<std::size_t>(std::max(segment, 0)) % kLightness.size();
  return displayable({kLightness[level], 0.17, std::fmod(kGoldenAngle * segment, 360.0)});
}

Colour shaded(const Colour& colour, double light) {
  constexpr double kDarkest = 0.38;   // share of the colour lost in the deepest shade
  constexpr double kLightest = 0.30;  // share of white mixed in at the brightest
  const double target = light > 0.0 ? 1.0 : 0.0;
  const double share = light > 0.0 ? kLightest * std::min(light, 1.0) : kDarkest * std::min(-light, 1.0);
  return {mix(colour.red, target, share), mix(colour.green, target, share), mix(colour.blue, target, share)};
}

std::uint32_t packed(const Colour& colour) {
  const auto byte = [](double channel) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0)));
  };
  return 0xff000000U | byte(colour.red) << 16U | byte(colour.green) << 8U | byte(colour.blue);
}

}  // namespace pcl_fft_ground::cli
