#include "pcl_fft_ground/plane_fit.h"

#include <pcl/point_types.h>
#include <pcl/sample_consensus/mlesac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace pcl_fft_ground {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/// PCL's plane model, with a seed of our own for its samples.
class SeededPlaneModel : public pcl::SampleConsensusModelPlane<Point> {
 public:
  SeededPlaneModel(const Cloud::ConstPtr& cloud, std::uint32_t seed)
      : SampleConsensusModelPlane<Point>(cloud) {
    rng_alg_.seed(seed);
  }
};

Cloud::Ptr sortedCloud(const core::Points& points) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    cloud->push_back({points(0, n), points(1, n), points(2, n)});
  std::sort(cloud->begin(), cloud->end(),
            [](const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  return cloud;
}

/// True if the points determine a plane: PCL complains on its console where they do not.
bool spanPlane(const core::Points& points) {
  if (points.cols() < 3) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(core::summarise(points).covariance);
  return solver.eigenvalues()[1] > 1e-9 * solver.eigenvalues()[2];
}

/// a x + b y + c z + d = 0 as z(x, y).
std::optional<core::Plane> asHeights(const Eigen::VectorXf& coefficients) {
  const Eigen::Vector4d plane = coefficients.cast<double>();
  constexpr double UPRIGHT = 0.01;
  if (!plane.allFinite() || std::abs(plane.z()) < UPRIGHT * plane.head<3>().norm()) return std::nullopt;
  return core::Plane{-plane.head<2>() / plane.z(), -plane[3] / plane.z()};
}

}  // namespace

std::optional<core::Plane> fitPlane(const core::Points& points, const PlaneFitParameters& parameters) {
  if (!spanPlane(points)) return std::nullopt;
  const SeededPlaneModel::Ptr model(new SeededPlaneModel(sortedCloud(points), parameters.seed));
  pcl::MaximumLikelihoodSampleConsensus<Point> mlesac(model, parameters.distance_threshold);
  mlesac.setMaxIterations(parameters.max_iterations);
  mlesac.setProbability(parameters.probability);
  if (!mlesac.computeModel()) return std::nullopt;

  Eigen::VectorXf coefficients;
  mlesac.getModelCoefficients(coefficients);
  if (parameters.optimize_coefficients) {
    pcl::Indices inliers;
    mlesac.getInliers(inliers);
    const Eigen::VectorXf found = coefficients;
    model->optimizeModelCoefficients(inliers, found, coefficients);
  }
  return asHeights(coefficients);
}

}  // namespace pcl_fft_ground
