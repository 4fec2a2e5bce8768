#pragma once

#include <pcl/exceptions.h>

#include <algorithm>
#include <stdexcept>

#include "pcl_fft_ground/impl/scan_describer.hpp"
#include "pcl_fft_ground/survey_alignment.h"

namespace pcl_fft_ground {

template <typename PointT>
void SurveyAlignment<PointT>::setAlignmentParameters(const core::AlignmentParameters& parameters) {
  try {
    core::validate(parameters);
  } catch (const std::invalid_argument& error) {
    throw pcl::PCLException(std::string("SurveyAlignment: ") + error.what());
  }
  parameters_ = parameters;
}

template <typename PointT>
std::size_t SurveyAlignment<PointT>::addScan(const PointCloudConstPtr& cloud,
                                             const Eigen::Isometry3d& world_from_scan,
                                             const core::NavigationSigmas& sigmas) {
  const auto refuse = [](const std::string& reason) {
    throw pcl::PCLException("SurveyAlignment: " + reason);
  };
  if (!cloud) refuse("there is no cloud");
  if (!world_from_scan.matrix().allFinite()) refuse("the pose is not finite");
  const core::Points points = impl::usablePointsOf<PointT>(*cloud, nullptr).points;
  if (points.cols() == 0) refuse("none of the scan's points is finite; at least one has to be");
  try {
    core::validate(sigmas);
    scans_.push_back(core::surveyScan(points, world_from_scan, sigmas));
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  core::ScanSegments segments = describer_.describe(cloud);
  descriptions_.push_back({std::move(segments), describer_.getError()});
  poses_.navigation.push_back(world_from_scan);
  poses_.chained.push_back(world_from_scan);
  poses_.global.push_back(world_from_scan);
  return scans_.size() - 1;
}

template <typename PointT>
const Eigen::Isometry3d& SurveyAlignment<PointT>::getPose(std::size_t id) const {
  if (id >= scans_.size())
    throw pcl::PCLException("SurveyAlignment: there is no scan " + std::to_string(id) + ", but " +
                            std::to_string(scans_.size()));
  return poses_.global[id];
}

template <typename PointT>
bool SurveyAlignment<PointT>::isTried(const core::SubmapPair& pair) const {
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const core::PairResult& tried) {
    return (tried.reference == pair.reference && tried.moving == pair.moving) ||
           (tried.reference == pair.moving && tried.moving == pair.reference);
  });
}

template <typename PointT>
void SurveyAlignment<PointT>::alignPair(const core::PlannedPair& pair, const Eigen::Isometry3d& guess) {
  const Description& moving = descriptions_[pair.scans.moving];
  const Description& reference = descriptions_[pair.scans.reference];
  const std::string error = moving.error.empty() ? reference.error : moving.error;
  if (error.empty())
    pairs_.push_back(core::alignPair(pair, scans_, moving.segments, reference.segments, guess, parameters_));
  else
    pairs_.push_back(core::notRun(pair, scans_, error));
}

template <typename PointT>
void SurveyAlignment<PointT>::solve() {
  poses_ = core::solveSurvey(scans_, pairs_, std::string());
  solved_ = scans_.size();
}

template <typename PointT>
void SurveyAlignment<PointT>::align() {
  for (const core::PlannedPair& pair : core::planPairs(scans_))
    if (!isTried(pair.scans)) alignPair(pair, core::guessOf(pair.scans, scans_));
  updated_ = scans_.size();
  try {
    solve();
  } catch (const std::exception& error) {
    throw pcl::PCLException(std::string("SurveyAlignment: ") + error.what());
  }
}

template <typename PointT>
void SurveyAlignment<PointT>::addNewcomer(std::size_t newcomer) {
  constexpr double GROWTH = 1.25;  // of the survey, from one solution for all poses to the next
  for (const core::PlannedPair& pair : core::pairsOfNewcomer(newcomer, scans_, poses_.global))
    if (!isTried(pair.scans))
      alignPair(pair, poses_.global[pair.scans.reference].inverse() * poses_.global[newcomer]);
  const core::RefinedPoses refined = core::refineAround(newcomer, scans_, pairs_, poses_.global);
  poses_.global = refined.poses;
  if (refined.contradicted || static_cast<double>(newcomer + 1) >= GROWTH * static_cast<double>(solved_))
    solve();
}

template <typename PointT>
void SurveyAlignment<PointT>::update() {
  try {
    for (; updated_ < scans_.size(); ++updated_) addNewcomer(updated_);
  } catch (const std::exception& error) {
    throw pcl::PCLException(std::string("SurveyAlignment: ") + error.what());
  }
}

}  // namespace pcl_fft_ground

#define PCL_INSTANTIATE_SurveyAlignment(T) \
  template class PCL_FFT_GROUND_REGISTRATION_EXPORT pcl_fft_ground::SurveyAlignment<T>;
