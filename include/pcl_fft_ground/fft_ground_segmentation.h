#pragma once

#include "pcl_fft_ground/core/low_pass_ground.h"
#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground {

/** Ground segmentation in the frequency domain, after Douillard et al. (2012), Sec. IV.
 *
 * The elevation map of the scan is low-passed; what stays is the ground, and points above it are objects. The
 * cut-off frequency is the peak of the spectrum closest to DC that keeps objects up to the largest object
 * size out of the ground. That size is all a user has to set, as a share of the scan's extent or in metres.
 *
 * \code
 * pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
 * filter.setInputCloud(scan);
 * filter.setMaximumObjectSize(1.0);
 * filter.filter(*objects);
 * \endcode
 */
template <typename PointT>
class FFTGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<FFTGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const FFTGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit FFTGroundSegmentation(bool extract_removed_indices = false);

  /// Side of an elevation cell [m], above 0. Default 0.02.
  void setCellSize(double cell_size);
  double getCellSize() const { return parameters_.cell_size; }

  /// Size of the largest object [m], above 0; larger ones count as ground. Takes the place of the relative
  /// size.
  void setMaximumObjectSize(double size);
  /// The size set in metres; NaN where the relative size is in force.
  double getMaximumObjectSize() const;

  /// m_u: size of the largest object as a share of the smaller horizontal extent, in (0, 1]. Default 0.5.
  /// Takes the place of the size in metres.
  void setRelativeMaximumObjectSize(double share);
  /// The share set; NaN where a size in metres is in force.
  double getRelativeMaximumObjectSize() const;

  /// f_c as a ratio of the Nyquist range, in (0, sqrt 2], or 0 to find it automatically (the default).
  void setCutoffFrequency(double cutoff);
  /// f_c of the last run; before that the value set, 0 for automatic.
  double getCutoffFrequency() const;

  /// n of eq. (1), in [1, 100]. Default 2.
  void setFilterOrder(unsigned order);
  unsigned getFilterOrder() const { return parameters_.filter_order; }

  /// A of eq. (1), attenuation at the cut-off [dB], in (0, 100]. Default 3.
  void setPassbandRipple(double ripple);
  double getPassbandRipple() const { return parameters_.passband_ripple; }

  /// k: a peak is compared with a window of (2 k + 1) x (2 k + 1) bins, k in [1, 1000]. Default 1,
  /// eight-connected.
  void setPeakWindow(unsigned half_window);
  unsigned getPeakWindow() const { return parameters_.peaks.half_window; }

  /// c of eq. (3): by how much a peak exceeds the rest of its window, finite, at least 0. Default 0.
  void setPeakThreshold(double threshold);
  double getPeakThreshold() const { return parameters_.peaks.threshold; }

  /// Whether the axes of the grid are lengthened to products of 2, 3 and 5 for the transform. Default SMOOTH.
  void setGridLengths(core::GridLengths lengths) { parameters_.grid_lengths = lengths; }
  core::GridLengths getGridLengths() const { return parameters_.grid_lengths; }

  /// Elevation grid of the last run; without cells before the first, and after a failed one.
  const core::ElevationGrid& getElevationGrid() const { return ground_.elevation; }
  /// Share of the elevation cells without a point, [0, 1].
  double getEmptyCellShare() const { return ground_.elevation.emptyCellShare(); }
  /// Spectrum of the elevation before the filter.
  const core::Spectrum& getSpectrum() const { return ground_.spectrum; }
  /// Spectrum after the filter; computed at each call.
  core::Spectrum getFilteredSpectrum() const { return ground_.filteredSpectrum(); }
  /// All peaks of the spectrum, by falling wavelength; both of each conjugate pair.
  const std::vector<core::SpectrumPeak>& getSpectrumPeaks() const { return ground_.peaks; }
  /// The cut-off of the last run: f_c, m_c and the peak that gave it.
  const core::Cutoff& getCutoff() const { return ground_.cutoff; }
  /// Height of the ground over the elevation cells.
  const core::GroundSurface& getGroundSurface() const override { return ground_.surface; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

 private:
  void warnOfDoubts();

  core::LowPassParameters parameters_;
  core::LowPassGround ground_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/fft_ground_segmentation.hpp>
#endif
