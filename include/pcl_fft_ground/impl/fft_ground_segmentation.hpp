#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "pcl_fft_ground/core/ground/ground_warnings.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/impl/ground_segmentation.hpp"

namespace pcl_fft_ground {
namespace impl {

constexpr double NOT_IN_FORCE = std::numeric_limits<double>::quiet_NaN();

inline core::Spectrum spectrumOf(const core::LowPassGround& ground) {
  return ground.spectrum;
}
inline core::Spectrum spectrumOf(const core::RobustGround& ground) {
  return core::forwardTransform(ground.elevation.elevation);
}

inline core::Spectrum groundSpectrumOf(const core::LowPassGround& ground) {
  return ground.filteredSpectrum();
}
inline core::Spectrum groundSpectrumOf(const core::RobustGround& ground) {
  return core::forwardTransform(ground.surface.height);
}

inline core::Cutoff cutoffOf(const core::LowPassGround& ground) {
  return ground.cutoff;
}
/// The finest wavelength as a ratio of the Nyquist range.
inline core::Cutoff cutoffOf(const core::RobustGround& ground) {
  core::Cutoff cutoff;
  if (ground.finest_wavelength <= 0) return cutoff;  // no run yet
  cutoff.source = core::CutoffSource::FINEST_WAVELENGTH;
  cutoff.frequency = std::min(M_SQRT2, 2 * ground.elevation.geometry.cell_size / ground.finest_wavelength);
  cutoff.object_size = core::largestObject(cutoff.frequency, ground.elevation.geometry.cell_size);
  return cutoff;
}

}  // namespace impl

template <typename PointT>
FFTGroundSegmentation<PointT>::FFTGroundSegmentation(bool extract_removed_indices)
    : GroundSegmentation<PointT>("FFTGroundSegmentation", core::FrameParameters(), extract_removed_indices) {
  setEstimator(Estimator::ROBUST);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setEstimator(Estimator estimator) {
  estimator_ = estimator;
  this->setDefaultUpEstimation(estimator == Estimator::ROBUST ? UpEstimation::AUTO
                                                              : UpEstimation::PRINCIPAL_AXIS);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setCellSize(double cell_size) {
  this->requireLength("cell size", cell_size);
  low_pass_.cell_size = cell_size;
  robust_.cell_size = cell_size;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getCellSize() const {
  if (estimator_ == Estimator::LOW_PASS) return low_pass_.cell_size;
  const core::GridGeometry& cells = getElevationGrid().geometry;
  return robust_.cell_size.value_or(cells.rows > 0 ? cells.cell_size : impl::NOT_IN_FORCE);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setMaximumObjectSize(double size) {
  this->requireLength("maximum object size", size);
  low_pass_.max_object_size = size;
  robust_.max_object_size = size;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getMaximumObjectSize() const {
  return low_pass_.max_object_size.value_or(impl::NOT_IN_FORCE);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setRelativeMaximumObjectSize(double share) {
  this->requireParameter(share > 0 && share <= 1, "relative maximum object size", share, "in (0, 1]");
  low_pass_.relative_max_object_size = share;
  low_pass_.max_object_size.reset();
  robust_.relative_max_object_size = share;
  robust_.max_object_size.reset();
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getRelativeMaximumObjectSize() const {
  return low_pass_.max_object_size ? impl::NOT_IN_FORCE : low_pass_.relative_max_object_size;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getHeightTolerance() const {
  if (estimator_ == Estimator::LOW_PASS || this->givenHeightTolerance())
    return GroundSegmentation<PointT>::getHeightTolerance();
  return chosen(&core::RobustGround::tolerance);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setFilterOrder(unsigned order) {
  this->requireParameter(order >= 1 && order <= 100, "filter order", order, "in [1, 100]");
  low_pass_.filter_order = order;
  robust_.filter_order = order;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPassbandRipple(double ripple) {
  this->requireParameter(ripple > 0 && ripple <= 100, "passband ripple", ripple, "in (0, 100] dB");
  low_pass_.passband_ripple = ripple;
  robust_.passband_ripple = ripple;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setMaximumSlope(double slope) {
  this->requireParameter(std::isfinite(slope) && slope >= 0, "maximum slope", slope,
                         "a finite number of at least 0");
  robust_.max_slope = slope > 0 ? std::optional<double>(slope) : std::nullopt;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setFinestWavelength(double wavelength) {
  this->requireLength("finest wavelength", wavelength);
  robust_.finest_wavelength = wavelength;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getFinestWavelength() const {
  return robust_.finest_wavelength.value_or(chosen(&core::RobustGround::finest_wavelength));
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setCutoffFrequency(double cutoff) {
  this->requireParameter(cutoff >= 0 && cutoff <= M_SQRT2, "cut-off frequency", cutoff,
                         "in (0, 1.41421], or 0 for automatic");
  low_pass_.cutoff_frequency = cutoff > 0 ? std::optional<double>(cutoff) : std::nullopt;
  if (auto* low_pass = std::get_if<core::LowPassGround>(&ground_)) low_pass->cutoff = core::Cutoff();
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getCutoffFrequency() const {
  if (estimator_ == Estimator::LOW_PASS && low_pass_.cutoff_frequency) return *low_pass_.cutoff_frequency;
  return getCutoff().frequency;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPeakWindow(unsigned half_window) {
  this->requireParameter(half_window >= 1 && half_window <= 1000, "peak window", half_window,
                         "in [1, 1000] bins");
  low_pass_.peaks.half_window = half_window;
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::setPeakThreshold(double threshold) {
  this->requireParameter(std::isfinite(threshold) && threshold >= 0, "peak threshold", threshold,
                         "a finite number of at least 0");
  low_pass_.peaks.threshold = threshold;
}

template <typename PointT>
const core::ElevationGrid& FFTGroundSegmentation<PointT>::getElevationGrid() const {
  return std::visit(
      [](const auto& ground) -> const auto& { return ground.elevation; }, ground_);
}

template <typename PointT>
core::Spectrum FFTGroundSegmentation<PointT>::getSpectrum() const {
  return std::visit([](const auto& ground) { return impl::spectrumOf(ground); }, ground_);
}

template <typename PointT>
core::Spectrum FFTGroundSegmentation<PointT>::getFilteredSpectrum() const {
  return std::visit([](const auto& ground) { return impl::groundSpectrumOf(ground); }, ground_);
}

template <typename PointT>
std::vector<core::SpectrumPeak> FFTGroundSegmentation<PointT>::getSpectrumPeaks() const {
  if (const auto* low_pass = std::get_if<core::LowPassGround>(&ground_)) return low_pass->peaks;
  return core::findSpectrumPeaks(core::magnitude(getSpectrum()), low_pass_.peaks);
}

template <typename PointT>
core::Cutoff FFTGroundSegmentation<PointT>::getCutoff() const {
  return std::visit([](const auto& ground) { return impl::cutoffOf(ground); }, ground_);
}

template <typename PointT>
const core::GroundSurface& FFTGroundSegmentation<PointT>::getGroundSurface() const {
  return std::visit(
      [](const auto& ground) -> const auto& { return ground.surface; }, ground_);
}

template <typename PointT>
std::vector<core::RobustChoice> FFTGroundSegmentation<PointT>::getChoices() const {
  const auto* robust = std::get_if<core::RobustGround>(&ground_);
  return robust != nullptr ? robust->choices : std::vector<core::RobustChoice>();
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::getGroundSpread() const {
  return chosen(&core::RobustGround::scale);
}

template <typename PointT>
std::vector<float> FFTGroundSegmentation<PointT>::getGroundProbability() const {
  const auto* robust = std::get_if<core::RobustGround>(&ground_);
  if (!input_ || robust == nullptr || robust->surface.height.size() == 0) return {};
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) return {};
  const core::UsablePoints level = this->levelPoints();
  const std::vector<float> known = core::groundProbability(level.points, *robust);
  std::vector<float> result(points.size(), std::numeric_limits<float>::quiet_NaN());
  for (const Eigen::Index n : level.far) result[static_cast<std::size_t>(n)] = 0;
  for (std::size_t n = 0; n < known.size(); ++n)
    result[static_cast<std::size_t>(level.column(static_cast<Eigen::Index>(n)))] = known[n];
  return result;
}

template <typename PointT>
double FFTGroundSegmentation<PointT>::chosen(double core::RobustGround::*value) const {
  const auto* robust = std::get_if<core::RobustGround>(&ground_);
  return robust != nullptr && robust->surface.height.size() > 0 ? robust->*value : impl::NOT_IN_FORCE;
}

template <typename PointT>
core::Labels FFTGroundSegmentation<PointT>::labelPoints(const core::Points& points,
                                                        const Eigen::Isometry3d& frame_from_input) {
  ground_ = core::LowPassGround();
  points_below_ = 0;
  if (points.cols() == 0) return {};
  return estimator_ == Estimator::LOW_PASS ? labelByLowPass(points, frame_from_input)
                                           : labelByRobustFit(points, frame_from_input);
}

template <typename PointT>
core::Labels FFTGroundSegmentation<PointT>::labelByLowPass(const core::Points& points,
                                                           const Eigen::Isometry3d& frame_from_input) {
  ground_ = core::estimateLowPassGround(points, frame_from_input, low_pass_);
  warnOfEmptyCells();
  warnOfLargeObjects();
  return core::labelByHeight(points, getGroundSurface(), getHeightTolerance());
}

template <typename PointT>
core::Labels FFTGroundSegmentation<PointT>::labelByRobustFit(const core::Points& points,
                                                             const Eigen::Isometry3d& frame_from_input) {
  core::RobustParameters parameters = robust_;
  parameters.height_tolerance = this->givenHeightTolerance();
  core::RobustGround ground = core::estimateRobustGround(points, frame_from_input, parameters);
  core::RobustLabels labelled = core::labelRobust(points, ground);
  ground_ = std::move(ground);
  points_below_ = labelled.below;
  for (const std::string& sentence :
       core::warningsAbout(std::get<core::RobustGround>(ground_), points, labelled.labels, parameters))
    this->warn(sentence);
  if (low_pass_.cutoff_frequency)
    this->warn("the cut-off frequency has no influence on the robust estimator: see setFinestWavelength()");
  return std::move(labelled.labels);
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::warnOfEmptyCells() {
  constexpr double MOST_EMPTY = 0.1;  // what the paper allows (Sec. IV-A)
  if (getEmptyCellShare() <= MOST_EMPTY) return;
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << 100 * getEmptyCellShare()
           << " % of the elevation cells hold no point: the method is meant for at most " << 100 * MOST_EMPTY
           << " %; larger cells may help, or the robust estimator";
  this->warn(sentence.str());
}

template <typename PointT>
void FFTGroundSegmentation<PointT>::warnOfLargeObjects() {
  const double extent = std::visit([](const auto& ground) { return ground.extent; }, ground_);
  if (!low_pass_.max_object_size || *low_pass_.max_object_size <= extent) return;
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << "the maximum object size of " << *low_pass_.max_object_size
           << " m exceeds the extent of the scan, " << extent << " m: are the coordinates in metres?";
  this->warn(sentence.str());
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_FFTGroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::FFTGroundSegmentation<T>;
