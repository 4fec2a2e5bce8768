#pragma once

#include <pcl/console/print.h>
#include <pcl/exceptions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>

#include <pcl/common/impl/io.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>

#include "pcl_fft_ground/core/scan/threads.h"
#include "pcl_fft_ground/ground_segmentation.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"

namespace pcl_fft_ground {
namespace impl {

/// The indices of the points whose label the predicate takes, in the order of the list.
template <typename PointT, typename Predicate>
pcl::Indices indicesWhere(const IndexedPoints<PointT>& points, const core::Labels& labels,
                          const Predicate& takes) {
  const auto size = static_cast<Eigen::Index>(labels.size());
  std::vector<std::size_t> places = core::resultsOfRanges(
      size, core::POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) -> std::size_t {
        return static_cast<std::size_t>(std::count_if(labels.begin() + begin, labels.begin() + end, takes));
      });
  std::size_t count = 0;
  for (std::size_t& place : places) count += std::exchange(place, count);
  pcl::Indices indices(count);
  core::forEachRange(size, core::POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    std::array<pcl::index_t, 256> taken;  // half of all branches would be mispredicted
    auto to = indices.begin() +
              static_cast<std::ptrdiff_t>(places[static_cast<std::size_t>(begin / core::POINTS_AT_A_TIME)]);
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end);) {
      const std::size_t block_end = std::min(n + taken.size(), static_cast<std::size_t>(end));
      std::size_t in_block = 0;
      for (; n < block_end; ++n) {
        taken[in_block] = points.index(n);
        in_block += takes(labels[n]) ? 1 : 0;
      }
      to = std::copy_n(taken.begin(), in_block, to);
    }
  });
  return indices;
}

}  // namespace impl

template <typename PointT>
GroundSegmentation<PointT>::GroundSegmentation(const std::string& name,
                                               const core::FrameParameters& frame_parameters,
                                               bool extract_removed_indices)
    : pcl::FilterIndices<PointT>(extract_removed_indices), frame_parameters_(frame_parameters) {
  filter_name_ = name;
}

template <typename PointT>
GroundSegmentation<PointT>::GroundSegmentation(const GroundSegmentation& other)
    : pcl::FilterIndices<PointT>(other),
      frame_parameters_(other.frame_parameters_),
      up_estimation_is_given_(other.up_estimation_is_given_),
      height_tolerance_(other.height_tolerance_),
      number_of_threads_(other.number_of_threads_),
      up_(other.up_),
      origin_(other.origin_),
      frame_from_input_(other.frame_from_input_),
      far_points_(other.far_points_),
      error_(other.error_),
      warnings_(other.warnings_) {
  if (fake_indices_) indices_.reset();  // PCLBase shares its list of all points, which a run may resize
}

template <typename PointT>
GroundSegmentation<PointT>& GroundSegmentation<PointT>::operator=(const GroundSegmentation& other) {
  if (this == &other) return *this;
  pcl::FilterIndices<PointT>::operator=(other);
  if (fake_indices_) indices_.reset();
  frame_parameters_ = other.frame_parameters_;
  up_estimation_is_given_ = other.up_estimation_is_given_;
  height_tolerance_ = other.height_tolerance_;
  number_of_threads_ = other.number_of_threads_;
  up_ = other.up_;
  origin_ = other.origin_;
  frame_from_input_ = other.frame_from_input_;
  far_points_ = other.far_points_;
  error_ = other.error_;
  warnings_ = other.warnings_;
  return *this;
}

template <typename PointT>
void GroundSegmentation<PointT>::segment(pcl::PointIndices& ground, pcl::PointIndices& objects) {
  ground = objects = pcl::PointIndices();
  // Without indices PCLBase would only make a list of all points, which nobody reads.
  const bool all_points = input_ && !indices_;
  if (!all_points && !initCompute()) return;
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  const core::Labels labels = computeLabels();
  ground.header = objects.header = input_->header;
  ground.indices = impl::indicesWhere(points, labels, [](core::Label l) { return l == core::Label::GROUND; });
  objects.indices =
      impl::indicesWhere(points, labels, [](core::Label l) { return l == core::Label::OBJECT; });
  deinitCompute();
}

template <typename PointT>
void GroundSegmentation<PointT>::setUpDirection(const Eigen::Vector3d& up) {
  const double length = up.stableNorm();
  requireParameter(up.allFinite() && length > 0, "length of the up direction", length,
                   "a finite number above 0");
  frame_parameters_.up_direction = (up / up.cwiseAbs().maxCoeff()).normalized();
}

template <typename PointT>
void GroundSegmentation<PointT>::setSensorPosition(const Eigen::Vector3d& position) {
  requireParameter(position.allFinite(), "distance of the sensor position from the origin", position.norm(),
                   "a finite number of metres");
  frame_parameters_.sensor_position = position;
}

template <typename PointT>
Eigen::Vector3d GroundSegmentation<PointT>::getSensorPosition() const {
  constexpr double NOT_SET = std::numeric_limits<double>::quiet_NaN();
  return frame_parameters_.sensor_position.value_or(Eigen::Vector3d::Constant(NOT_SET));
}

template <typename PointT>
void GroundSegmentation<PointT>::setUpEstimation(UpEstimation estimation) {
  frame_parameters_.up_estimation = estimation;
  up_estimation_is_given_ = true;
}

template <typename PointT>
void GroundSegmentation<PointT>::setDefaultUpEstimation(UpEstimation estimation) {
  if (!up_estimation_is_given_) frame_parameters_.up_estimation = estimation;
}

template <typename PointT>
std::vector<double> GroundSegmentation<PointT>::getHeightAboveGround() const {
  const core::GroundSurface& surface = getGroundSurface();
  if (!input_ || surface.height.size() == 0) return {};
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) return {};
  std::vector<double> heights(points.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t n = 0; n < points.size(); ++n)
    if (points.isFinite(n)) heights[n] = surface.heightAbove(points.place(n));
  return heights;
}

template <typename PointT>
core::Points GroundSegmentation<PointT>::getLevelPoints() const {
  return levelPoints().points;
}

template <typename PointT>
core::UsablePoints GroundSegmentation<PointT>::levelPoints() const {
  if (!input_) return {};
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) return {};
  const Eigen::Isometry3d frame_from_points = frame_from_input_ * Eigen::Translation3d(origin_);
  core::UsablePoints usable = core::usablePoints(points.rawPoints(origin_));
  usable.points = core::transformed(usable.points, frame_from_points);
  return usable;
}

template <typename PointT>
void GroundSegmentation<PointT>::setHeightTolerance(double tolerance) {
  requireParameter(std::isfinite(tolerance), "height tolerance", tolerance, "a finite number of metres");
  height_tolerance_ = tolerance;
}

template <typename PointT>
void GroundSegmentation<PointT>::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  PCL_WARN("[pcl_fft_ground::%s] %s\n", filter_name_.c_str(), sentence.c_str());
}

template <typename PointT>
void GroundSegmentation<PointT>::requireParameter(bool valid, const std::string& parameter, double value,
                                                  const std::string& range) const {
  if (valid) return;
  std::ostringstream message;
  message << filter_name_ << ": " << parameter << " is " << value << ", must be " << range;
  throw pcl::PCLException(message.str());
}

template <typename PointT>
void GroundSegmentation<PointT>::requireLength(const std::string& parameter, double value) const {
  requireParameter(std::isfinite(value) && value > 0, parameter, value, "a finite number of metres above 0");
}

template <typename PointT>
void GroundSegmentation<PointT>::applyFilter(pcl::Indices& indices) {
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  const core::Labels labels = computeLabels();
  const core::Label kept = keptLabel();
  // Both lists are made before either is handed out: the output may be the vector that was given as input.
  pcl::Indices result = impl::indicesWhere(points, labels, [kept](core::Label l) { return l == kept; });
  removed_indices_.reset(new pcl::Indices);
  if (extract_removed_indices_)
    *removed_indices_ = impl::indicesWhere(points, labels, [kept](core::Label l) { return l != kept; });
  indices = std::move(result);
}

template <typename PointT>
void GroundSegmentation<PointT>::applyFilter(PointCloud& output) {
  const core::Threads threads(number_of_threads_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  const core::Labels labels = computeLabels();
  const core::Label kept = keptLabel();
  removed_indices_.reset(new pcl::Indices);
  if (extract_removed_indices_)
    *removed_indices_ = impl::indicesWhere(points, labels, [kept](core::Label l) { return l != kept; });
  const bool invalid_indices = labels.empty() && points.size() > 0;
  if (keep_organized_ && !invalid_indices)
    copyOrganized(labels, output);
  else
    copyPoints(impl::indicesWhere(points, labels, [kept](core::Label l) { return l == kept; }), output);
}

/// The points made ready near the origin, the frame taking them where they are.
template <typename PointT>
core::PreparedScan GroundSegmentation<PointT>::prepare(const impl::IndexedPoints<PointT>& points) {
  origin_ = points.origin();
  core::FrameParameters parameters = frame_parameters_;
  if (parameters.sensor_position) *parameters.sensor_position -= origin_;
  core::PreparedScan scan = core::prepare(points.rawPoints(origin_), parameters);
  scan.frame_from_input = scan.frame_from_input * Eigen::Translation3d(-origin_);
  return scan;
}

/// A label per index; none at all if an index, or the cloud, is invalid.
template <typename PointT>
core::Labels GroundSegmentation<PointT>::computeLabels() {
  warnings_.clear();
  error_.clear();
  far_points_.clear();
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  if (!points.areValid()) {
    up_ = core::UpDirection();
    labelScan(core::PreparedScan());  // forgets the last run
    reportError(points.problem());
    return {};
  }
  const core::PreparedScan scan = prepare(points);
  up_ = scan.up;
  for (const std::string& sentence : up_.warnings) warn(sentence);
  core::Labels labels = labelScan(scan);
  const std::vector<Eigen::Index>& far = scan.usable.far;
  if (static_cast<Eigen::Index>(far.size()) > scan.usable.points.cols())
    reportError("most coordinates are larger than can be computed with, beyond 1e18");
  for (const Eigen::Index n : far) far_points_.push_back(points.index(static_cast<std::size_t>(n)));
  if (!far.empty())
    warn("points too far from all others to belong to the scan, left out as objects: " +
         std::to_string(far.size()));
  if (labels.size() == points.size()) return labels;

  core::Labels scattered(points.size(), core::Label::NEITHER);
  for (std::size_t n = 0; n < labels.size(); ++n)
    scattered[static_cast<std::size_t>(scan.usable.column(static_cast<Eigen::Index>(n)))] = labels[n];
  const core::Label far_label = error_.empty() ? core::Label::OBJECT : core::Label::GROUND;
  for (const Eigen::Index n : far) scattered[static_cast<std::size_t>(n)] = far_label;
  return scattered;
}

/// Lets the method label the points of a scan; all ground where it cannot.
template <typename PointT>
core::Labels GroundSegmentation<PointT>::labelScan(const core::PreparedScan& scan) {
  frame_from_input_ = scan.frame_from_input;
  try {
    return labelPoints(scan.usable.points, frame_from_input_);
  } catch (const std::exception& problem) {
    reportError(problem.what());
    return core::Labels(static_cast<std::size_t>(scan.usable.points.cols()), core::Label::GROUND);
  }
}

template <typename PointT>
void GroundSegmentation<PointT>::reportError(const std::string& sentence) {
  error_ = sentence;
  PCL_ERROR("[pcl_fft_ground::%s] %s\n", filter_name_.c_str(), sentence.c_str());
}

/// The points of the indices, one after the other; the width and height of the input if they are all of its
/// points.
template <typename PointT>
void GroundSegmentation<PointT>::copyPoints(const pcl::Indices& indices, PointCloud& output) const {
  const impl::CloudView<PointT> input(*input_);
  bool complete = indices.size() == input.size();
  for (std::size_t n = 0; complete && n < indices.size(); ++n)
    complete = static_cast<std::size_t>(indices[n]) == n;
  input.copy(indices, output);
  output.width = complete ? input_->width : static_cast<std::uint32_t>(indices.size());
  output.height = complete ? input_->height : 1;
  output.is_dense = input_->is_dense;
  if constexpr (std::is_same_v<PointT, pcl::PCLPointCloud2>)
    output.row_step = output.width * output.point_step;
}

/// The whole input, x, y and z of what is not kept replaced by the user's value.
template <typename PointT>
void GroundSegmentation<PointT>::copyOrganized(const core::Labels& labels, PointCloud& output) const {
  output = *input_;
  const impl::CloudView<PointT> input(*input_);
  const impl::IndexedPoints<PointT> points(*input_, fake_indices_ ? nullptr : indices_.get());
  for (std::size_t n = 0; n < labels.size(); ++n)
    if (labels[n] != keptLabel())
      input.replace(static_cast<std::size_t>(points.index(n)), user_filter_value_, output);
  if (!labels.empty() && !std::isfinite(user_filter_value_)) output.is_dense = false;
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_GroundSegmentation(T) \
  template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::GroundSegmentation<T>;

// For the sources of the siblings: their base is instantiated, and exported, in a source of its own.
#define PCL_INSTANTIATE_ExternGroundSegmentation(T) \
  extern template class PCL_FFT_GROUND_FILTERS_EXPORT pcl_fft_ground::GroundSegmentation<T>;
