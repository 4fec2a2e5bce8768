#pragma once

#include <cstdint>

#include "pcl_fft_ground/ground_segmentation.h"
#include "pcl_fft_ground/plane_fit.h"

namespace pcl_fft_ground {

/** The paper's second benchmark (Sec. V-B2): PCL's MLESAC fits a plane, and ground is what lies on or below
 * it.
 *
 * A point lies on the plane if it is within the threshold of it. The points are brought into a fixed order
 * first, so that equal seeds and equal sets of points give equal planes. Where no plane is found, or only a
 * vertical one, every point counts as ground and a warning is given. Works in the input's own frame: up is
 * GIVEN unless set otherwise.
 */
template <typename PointT>
class PlanarGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<PlanarGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const PlanarGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit PlanarGroundSegmentation(bool extract_removed_indices = false);

  /// Distance up to which a point lies on the plane [m], finite and above 0. Default 0.02.
  void setDistanceThreshold(double threshold);
  double getDistanceThreshold() const { return parameters_.distance_threshold; }

  /// Most planes to try, at least 1. Default 1000.
  void setMaxIterations(int iterations);
  int getMaxIterations() const { return parameters_.max_iterations; }

  /// Probability of having tried a sample without outliers, in (0, 1). Default 0.99.
  void setProbability(double probability);
  double getProbability() const { return parameters_.probability; }

  /// Whether the plane is fitted to all of its inliers in the end. Default true.
  void setOptimizeCoefficients(bool optimize) { parameters_.optimize_coefficients = optimize; }
  bool getOptimizeCoefficients() const { return parameters_.optimize_coefficients; }

  /// Seed of the samples. Default 1.
  void setSeed(std::uint32_t seed) { parameters_.seed = seed; }
  std::uint32_t getSeed() const { return parameters_.seed; }

  /// The plane, level where none was found.
  const core::GroundSurface& getGroundSurface() const override { return surface_; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

 private:
  PlaneFitParameters parameters_;
  core::GroundSurface surface_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/planar_ground_segmentation.hpp>
#endif
