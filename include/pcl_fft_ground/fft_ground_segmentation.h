#pragma once

#include <variant>

#include "pcl_fft_ground/core/ground/low_pass_ground.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground {

using core::CellStatistic;

/// How the band-limited ground is found.
enum class Estimator {
  LOW_PASS,  ///< as published: a Butterworth low-pass of the highest points (core::estimateLowPassGround())
  ROBUST,    ///< fitted to the ground cells only, coarse to fine (core::estimateRobustGround())
};

/** Ground segmentation in the frequency domain, after Douillard et al. (2012), Sec. IV.
 *
 * The ground is the part of the elevation map with long wavelengths; points above it are objects. The size of
 * the largest object is all a user has to set, as a share of the scan's extent or in metres. The estimator
 * ROBUST, the default, chooses what else it needs from the data, and getChoices() gives the reasons; LOW_PASS
 * is the published method with its parameters.
 *
 * \code
 * pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
 * filter.setInputCloud(scan);
 * filter.setMaximumObjectSize(1.0);
 * filter.filter(*objects);
 * \endcode
 *
 * A cloud of any fields, all of which are kept:
 *
 * \code
 * pcl_fft_ground::FFTGroundSegmentation<pcl::PCLPointCloud2> filter;
 * filter.setInputCloud(message);  // a pcl::PCLPointCloud2::ConstPtr: pcl::io::loadPCDFile(), pcl_conversions
 * filter.setMaximumObjectSize(1.0);
 * filter.filter(objects);  // a pcl::PCLPointCloud2
 * \endcode
 */
template <typename PointT>
class FFTGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<FFTGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const FFTGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit FFTGroundSegmentation(bool extract_removed_indices = false);

  /// ROBUST by default. Up is then found by AUTO, with LOW_PASS by PRINCIPAL_AXIS, unless it was set.
  void setEstimator(Estimator estimator);
  Estimator getEstimator() const { return estimator_; }

  /// Side of an elevation cell [m], above 0. Default: 0.02; ROBUST: chosen from the data.
  void setCellSize(double cell_size);
  /// The side set; where it is chosen from the data that of the last run, NaN before the first.
  double getCellSize() const;

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

  /// The height tolerance [m] set; with ROBUST, where it is not, that chosen in the last run, NaN before the
  /// first.
  double getHeightTolerance() const override;

  /// n of eq. (1), in [1, 100]. Default 2.
  void setFilterOrder(unsigned order);
  unsigned getFilterOrder() const { return low_pass_.filter_order; }

  /// A of eq. (1), attenuation at the cut-off [dB], in (0, 100]. Default 3.
  void setPassbandRipple(double ripple);
  double getPassbandRipple() const { return low_pass_.passband_ripple; }

  /// ROBUST: steepest ground [m/m], for land that breaks at banks, terraces and quays; 0 for none, the
  /// default.
  void setMaximumSlope(double slope);
  double getMaximumSlope() const { return robust_.max_slope.value_or(0.0); }

  /// ROBUST: shortest wavelength of the ground [m], above 0; less than two cells acts as two. Default: chosen
  /// from the data.
  void setFinestWavelength(double wavelength);
  /// The wavelength set; where it is chosen from the data that of the last run, NaN before the first.
  double getFinestWavelength() const;

  /// ROBUST: which height stands for a cell until the ground points in it are known. Default LOWEST.
  void setCellStatistic(CellStatistic statistic) { robust_.statistic = statistic; }
  CellStatistic getCellStatistic() const { return robust_.statistic.value_or(CellStatistic::LOWEST); }

  /// LOW_PASS: f_c as a ratio of the Nyquist range, in (0, sqrt 2], or 0 to find it automatically (the
  /// default).
  void setCutoffFrequency(double cutoff);
  /// f_c of the last run; before that the value set, 0 for automatic.
  double getCutoffFrequency() const;

  /// k: a peak is compared with a window of (2 k + 1) x (2 k + 1) bins, k in [1, 1000]. Default 1,
  /// eight-connected.
  void setPeakWindow(unsigned half_window);
  unsigned getPeakWindow() const { return low_pass_.peaks.half_window; }

  /// c of eq. (3): by how much a peak exceeds the rest of its window, finite, at least 0. Default 0.
  void setPeakThreshold(double threshold);
  double getPeakThreshold() const { return low_pass_.peaks.threshold; }

  /// LOW_PASS: whether the axes of the grid are lengthened to products of 2, 3 and 5 for the transform.
  /// Default SMOOTH.
  void setGridLengths(core::GridLengths lengths) { low_pass_.grid_lengths = lengths; }
  core::GridLengths getGridLengths() const { return low_pass_.grid_lengths; }

  /// Elevation grid of the last run; without cells before the first, and after a failed one.
  const core::ElevationGrid& getElevationGrid() const;
  /// Share of the elevation cells without a point, [0, 1].
  double getEmptyCellShare() const { return getElevationGrid().emptyCellShare(); }
  /// Spectrum of the elevation; computed at each call with ROBUST.
  core::Spectrum getSpectrum() const;
  /// Spectrum of the ground: with LOW_PASS the former after the filter. Computed at each call.
  core::Spectrum getFilteredSpectrum() const;
  /// All peaks of the spectrum, by falling wavelength; both of each conjugate pair. Found at each call with
  /// ROBUST, which does without them.
  std::vector<core::SpectrumPeak> getSpectrumPeaks() const;
  /// The cut-off of the last run: f_c, m_c and where they come from.
  core::Cutoff getCutoff() const;
  /// Height of the ground over the elevation cells.
  const core::GroundSurface& getGroundSurface() const override;

  /// Values that ROBUST chose from the data in the last run, with their reasons.
  std::vector<core::RobustChoice> getChoices() const;
  /// Spread [m] of the ground points around the surface of ROBUST, a standard deviation; NaN before a run.
  double getGroundSpread() const;
  /** How likely each point of the input is ground, in [0, 1], by the last run of ROBUST: see
   * core::groundProbability(). In the order of setIndices(); NaN for points that are not finite, 0 for those
   * too far from all others. Empty where there is no such run, or no input. Computed at each call.
   */
  std::vector<float> getGroundProbability() const;
  /// Points so deep below the ground of the last run, with ROBUST, that they are noise; they count as
  /// objects.
  std::size_t getPointsBelowGround() const { return points_below_; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::fake_indices_;
  using GroundSegmentation<PointT>::input_;

 private:
  core::Labels labelByLowPass(const core::Points& points, const Eigen::Isometry3d& frame_from_input);
  core::Labels labelByRobustFit(const core::Points& points, const Eigen::Isometry3d& frame_from_input);
  void warnOfEmptyCells();
  void warnOfLargeObjects();

  /// A value of the last run, if that was one of ROBUST that found a ground; NaN otherwise.
  double chosen(double core::RobustGround::*value) const;

  Estimator estimator_ = Estimator::ROBUST;
  core::LowPassParameters low_pass_;
  core::RobustParameters robust_;
  std::variant<core::LowPassGround, core::RobustGround> ground_;  ///< of the last run
  std::size_t points_below_ = 0;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/fft_ground_segmentation.hpp>
#endif
