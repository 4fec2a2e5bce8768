#pragma once

#include <Eigen/Core>
#include <vector>

#include "pictures/axes.h"
#include "pictures/canvas.h"

/// What drawSpectrum() shows of a full-plane spectrum: magnitudes with DC at (0, 0).
namespace pcl_fft_ground::cli {

/// Signed frequency of a bin (0 .. size - 1, or any number equal to it modulo size) as a ratio of Nyquist, in
/// [-1, 1).
double ratioOf(Eigen::Index bin, Eigen::Index size);

/// 20 log10 of a magnitude relative to a positive reference; minus infinity for 0.
double decibel(double magnitude, double reference);

/// The largest finite magnitude other than DC's; 1 where there is none above 0.
double referenceOf(const Eigen::ArrayXXd& magnitudes);

/// Lower end of the dB scale, a multiple of 10 in [-120, -60]: room for nearly all of the unfiltered spectrum
/// and 10 dB more.
double floorDecibel(const Eigen::ArrayXXd& before, double reference);

/// The part of the shifted spectrum within +-span (ratio of Nyquist) of DC in side x side pixels. Each pixel
/// shows the largest of its bins, so that peaks stay. Needs at least one bin.
Pixels spectrumPixels(const Eigen::ArrayXXd& magnitudes, double span, Eigen::Index side, double reference,
                      const ColourScale& scale);

/// (radius as a ratio of Nyquist, mean power in dB) of rings spaced evenly in log radius along the axis;
/// rings without bins are left out, DC is in none.
std::vector<Eigen::Vector2d> radialProfile(const Eigen::ArrayXXd& magnitudes, const Axis& radii,
                                           double reference);

}  // namespace pcl_fft_ground::cli
