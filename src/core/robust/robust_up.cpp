#include "robust/robust_up.h"

#include <Eigen/Eigenvalues>
#include <vector>

#include "pcl_fft_ground/core/point_statistics.h"
#include "robust/radix_sort.h"
#include "robust/robust_sample.h"

namespace pcl_fft_ground::core {
namespace {

/// A sheet of points: its normal and the variances along that and along the next axis.
struct Sheet {
  Eigen::Vector3d normal;
  double thickness = 0, breadth = 0;  ///< [m^2]
};

Sheet principalSheet(const PointsView& points, const Eigen::Vector3d& given) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(summarise(points).covariance);
  const Eigen::Vector3d axis = solver.eigenvectors().col(0);
  const Eigen::Vector3d variance = solver.eigenvalues();
  return {axis.dot(given) < 0 ? Eigen::Vector3d(-axis) : axis, variance[0], variance[1]};
}

/// The half of the points that lies in the thinnest slab across a direction.
Points thinnestHalf(const Points& points, const Eigen::Vector3d& direction, RadixSort& sort) {
  const Eigen::VectorXf heights = (direction.cast<float>().transpose() * points).transpose();
  std::vector<float> sorted(heights.data(), heights.data() + heights.size());
  sort(sorted);
  const std::size_t half = sorted.size() / 2;
  std::size_t lowest = 0;
  for (std::size_t n = 0; n + half < sorted.size(); ++n)
    if (sorted[n + half] - sorted[n] < sorted[lowest + half] - sorted[lowest]) lowest = n;
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index n = 0; n < heights.size(); ++n)
    if (heights[n] >= sorted[lowest] && heights[n] <= sorted[lowest + half]) chosen.push_back(n);
  return points(Eigen::all, chosen);
}

Sheet concentrated(const Points& points, const Eigen::Vector3d& start, const Eigen::Vector3d& given) {
  constexpr int STEPS = 30;
  constexpr double SETTLED = 5e-4;  // [rad]
  Sheet sheet{start};
  RadixSort sort;
  for (int n = 0; n < STEPS; ++n) {
    const Eigen::Vector3d last = sheet.normal;
    sheet = principalSheet(thinnestHalf(points, last, sort), given);
    if ((sheet.normal - last).norm() < SETTLED) break;
  }
  return sheet;
}

bool isTrusted(const Sheet& sheet, const Eigen::Vector3d& given) {
  constexpr double FLATTEST_VARIANCE_RATIO = 0.01;  // a tenth, squared: half of a slab is half as thick
  constexpr double MOST_LEANING = 0.7071;           // cosine of 45 degrees
  return sheet.breadth > 0 && sheet.thickness <= FLATTEST_VARIANCE_RATIO * sheet.breadth &&
         sheet.normal.dot(given) >= MOST_LEANING;
}

/// The thinner of the trusted sheets that the two starts lead to.
std::optional<Sheet> flattestHalf(const Points& points, const Eigen::Vector3d& given) {
  std::optional<Sheet> best;
  for (const Eigen::Vector3d& start : {given, principalSheet(points, given).normal}) {
    const Sheet sheet = concentrated(points, start, given);
    if (isTrusted(sheet, given) && (!best || sheet.thickness < best->thickness)) best = sheet;
  }
  return best;
}

}  // namespace

std::optional<Eigen::Vector3d> normalOfFlattestHalf(const PointsView& points, const Eigen::Vector3d& given) {
  constexpr Eigen::Index FEWEST_POINTS = 8, ENOUGH = 4000, ENOUGH_TO_START = 1000;
  const Points sample = sampleOf(points, ENOUGH);
  if (sample.cols() < FEWEST_POINTS) return std::nullopt;
  const Points few = sampleOfSample(sample, points.cols(), ENOUGH_TO_START);
  const std::optional<Sheet> rough = few.cols() < FEWEST_POINTS ? std::nullopt : flattestHalf(few, given);
  if (!rough) return std::nullopt;
  const Sheet sheet = concentrated(sample, rough->normal, given);
  return isTrusted(sheet, given) ? std::optional<Eigen::Vector3d>(sheet.normal) : std::nullopt;
}

}  // namespace pcl_fft_ground::core
