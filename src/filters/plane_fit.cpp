#include "pcl_fft_ground/plane_fit.h"

#include <pcl/point_types.h>
#include <pcl/sample_consensus/mlesac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace pcl_fft_ground {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/// PCL's plane model, with a seed of our own for its samples, and without its complaint about each bad one.
class SeededPlaneModel : public pcl::SampleConsensusModelPlane<Point> {
 public:
  SeededPlaneModel(const Cloud::ConstPtr& cloud, std::uint32_t seed)
      : SampleConsensusModelPlane<Point>(cloud) {
    rng_alg_.seed(seed);
  }

 protected:
  /// PCL's own test: three points on a line, or almost in one place, are no sample.
  bool isSampleGood(const pcl::Indices& samples) const override {
    const auto place = [&](std::size_t n) {
      return (*input_)[static_cast<std::size_t>(samples[n])].getVector3fMap();
    };
    const Eigen::Vector3f normal = (place(1) - place(0)).cross(place(2) - place(0));
    // A little stricter than PCL, or rounding might let a sample pass here that it rejects later, and aloud.
    return normal.stableNorm() > 1.01f * Eigen::NumTraits<float>::dummy_precision();
  }
};

Cloud::Ptr sortedCloud(const core::Points& points) {
  Cloud::Ptr cloud(new Cloud(static_cast<std::uint32_t>(points.cols()), 1));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    (*cloud)[static_cast<std::size_t>(n)].getVector3fMap() = points.col(n);
  std::sort(cloud->begin(), cloud->end(),
            [](const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  return cloud;
}

/// The power of two that brings the extent of the points to 1 or a little less than 2: PCL takes three points
/// for a plane only where they span more than a hundred thousandth of a square metre, whatever the unit.
double ownUnit(const core::Points& points) {
  const core::Bounds bounds = core::boundsOf(points);
  constexpr int MOST = std::numeric_limits<float>::max_exponent - 2;
  return std::ldexp(1.0, std::clamp(-std::ilogb((bounds.high - bounds.low).maxCoeff()), -MOST, MOST));
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
  const double unit = ownUnit(points);
  const core::Points scaled = points * static_cast<float>(unit);
  const SeededPlaneModel::Ptr model(new SeededPlaneModel(sortedCloud(scaled), parameters.seed));
  pcl::MaximumLikelihoodSampleConsensus<Point> mlesac(model, parameters.distance_threshold * unit);
  mlesac.setMaxIterations(parameters.max_iterations);
  mlesac.setProbability(parameters.probability);
  if (!mlesac.computeModel()) return std::nullopt;

  Eigen::VectorXf coefficients;
  mlesac.getModelCoefficients(coefficients);
  pcl::Indices inliers;
  mlesac.getInliers(inliers);
  // The sample alone has nothing to add, and PCL says so on its console.
  if (parameters.optimize_coefficients && inliers.size() > model->getSampleSize()) {
    const Eigen::VectorXf found = coefficients;
    model->optimizeModelCoefficients(inliers, found, coefficients);
  }
  coefficients[3] /= static_cast<float>(unit);
  return asHeights(coefficients);
}

}  // namespace pcl_fft_ground
