#pragma once

#include <array>
#include <cstdint>

namespace pcl_fft_ground::cli {

/// A colour in sRGB, each channel in [0, 1].
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

/// A colour map: evenly spaced samples from the low end to the high end.
using Palette = std::array<Colour, 256>;

/// Map for heights, dark blue over green to light yellow. Its lightness in OKLab (B. Ottosson, "A perceptual
/// colour space for image processing", 2020) rises linearly, so equal steps of height look equal, also in
/// grey print and to colour-blind readers.
const Palette& heightPalette();

/// Map for magnitudes in dB, near-black over a muted blue and grey to cream. Lightness linear as above; it
/// keeps away from magenta, the colour of the cut-off.
const Palette& spectrumPalette();

/// The colour at `share` of the way along a palette; shares outside [0, 1] take the end's colour, NaN the low
/// end's.
Colour colourAt(const Palette& palette, double share);

/// Colour of segment 1, 2, ...: hues a golden angle apart on three levels of lightness, so that neighbours in
/// number differ clearly. The same number always has the same colour.
Colour segmentColour(int segment);

/// Lightens (light > 0) or darkens (light < 0) a colour gently; `light` in [-1, 1], 0 leaves it as it is.
Colour shaded(const Colour& colour, double light);

/// The colour as one pixel, 0xffRRGGBB.
std::uint32_t packed(const Colour& colour);

}  // namespace pcl_fft_ground::cli
