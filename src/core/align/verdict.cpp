#include "align/verdict.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = 3.14159265358979323846 / 180;
constexpr double SLACK = 1.15;            // the last refinement may leave the gates by so much
constexpr double CORRELATED_POINTS = 10;  // errors of so many neighbouring points are the same

double largestDeviation(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
}

constexpr double NEAR = 1.5;                 // points this near agree [voxels]
constexpr Eigen::Index SCORE_SAMPLE = 3000;  // points of each scan

/// Adds the points that the other scan has seen, and those that agree with it.
template <typename Sees>
void count(const Points& sample, const Eigen::Isometry3d& transform, const NearestNeighbours& search,
           const Sees& sees, float near, Eigen::Index one_in, std::size_t& seen, std::size_t& agreeing) {
  for (Eigen::Index n = 0; n < sample.cols(); n += one_in) {
    const Eigen::Vector3d point = transform * sample.col(n).cast<double>();
    if (!sees(point)) continue;
    ++seen;
    if (search.nearest(point.cast<float>(), near).index >= 0) ++agreeing;
  }
}

}  // namespace

std::string exceeding(const std::string& what, double value, double allowed, const std::string& unit) {
  std::ostringstream text;
  text << std::setprecision(3) << what << " is " << value << unit << ", allowed are " << allowed << unit;
  return text.str();
}

AlignmentScore::AlignmentScore(const ScanPair& pair)
    : pair_(pair),
      moving_(transformed(pair.movingScan().objects, pair.initialGuess())),
      moving_sample_(evenSample(moving_, SCORE_SAMPLE)),
      reference_sample_(evenSample(pair.referenceScan().objects, SCORE_SAMPLE)),
      moving_search_(pair.parameters().neighbours(moving_, pair.voxelSize())),
      reference_search_(pair.parameters().neighbours(pair.referenceScan().objects, pair.voxelSize())) {}

Agreement AlignmentScore::of(const Eigen::Isometry3d& correction, Eigen::Index one_in) const {
  const auto near = static_cast<float>(NEAR * pair_.voxelSize());
  std::size_t seen = 0;
  std::size_t agreeing = 0;
  count(
      moving_sample_, correction, *reference_search_,
      [this](const Eigen::Vector3d& place) { return pair_.referenceSees(place); }, near, one_in, seen,
      agreeing);
  count(
      reference_sample_, correction.inverse(), *moving_search_,
      [this](const Eigen::Vector3d& place) { return pair_.movingSees(place); }, near, one_in, seen, agreeing);
  if (seen == 0) return {};
  return {static_cast<double>(agreeing) / static_cast<double>(seen), seen};
}

std::vector<Eigen::Isometry3d> placesAround(const Eigen::Isometry3d& pose, double voxel_size) {
  constexpr int COUNT = 12;
  constexpr double NEAREST = 6, FARTHEST = 16, GOLDEN_ANGLE = 2.39996322972865332;
  std::vector<Eigen::Isometry3d> places;
  for (int n = 0; n < COUNT; ++n) {
    const double distance = voxel_size * (NEAREST + (FARTHEST - NEAREST) * n / (COUNT - 1));
    const Eigen::AngleAxisd heading(n * GOLDEN_ANGLE, Eigen::Vector3d::UnitZ());
    places.emplace_back(Eigen::Translation3d(heading * Eigen::Vector3d(distance, 0, 0)) * pose);
  }
  return places;
}

double overlapOf(const ScanPair& pair, const Eigen::Isometry3d& correction) {
  return overlapShare(pair.referenceScan().coverage, pair.movingScan().coverage,
                      correction * pair.initialGuess());
}

std::optional<Matrix6d> covarianceAboutCentre(const IcpResult& icp) {
  constexpr double UNHELD = 1e-9;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(icp.information);
  const Vector6d values = solver.eigenvalues();
  if (!(values[0] > UNHELD * values[5])) return std::nullopt;
  const double least = icp.least_deviation * icp.least_deviation;
  const double variance = CORRELATED_POINTS * std::max(icp.variance, least);
  const Matrix6d of_noise = variance * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
                            solver.eigenvectors().transpose();
  return Matrix6d(of_noise + icp.spread);
}

std::string reasonAgainstMotion(const ScanPair& pair, const IcpResult& icp) {
  const SearchGates& gates = pair.parameters().gates;
  const Eigen::Vector3d moved = icp.centre - icp.correction.inverse() * icp.centre;
  const double turn = std::abs(yawOf(icp.correction)) / DEGREE;
  const double tilt = tiltOf(icp.correction) / DEGREE;
  if (moved.head<2>().norm() > SLACK * gates.max_shift)
    return exceeding("the shift", moved.head<2>().norm(), SLACK * gates.max_shift, " m");
  if (std::abs(moved.z()) > SLACK * gates.max_rise)
    return exceeding("the rise", std::abs(moved.z()), SLACK * gates.max_rise, " m");
  if (turn > SLACK * gates.max_turn) return exceeding("the turn", turn, SLACK * gates.max_turn, " degrees");
  if (tilt > gates.max_tilt) return exceeding("the tilt", tilt, gates.max_tilt, " degrees");
  return {};
}

std::string reasonAgainst(const ScanPair& pair, const IcpResult& icp) {
  std::string reason = reasonAgainstMotion(pair, icp);
  if (!reason.empty()) return reason;
  const std::optional<Matrix6d> covariance = covarianceAboutCentre(icp);
  if (!covariance) return "the matched points leave a direction free";
  const double max_sigma = largestSigma(pair.parameters(), pair.voxelSize());
  const double sigma = largestDeviation(covariance->topLeftCorner<2, 2>());
  if (sigma > max_sigma) return exceeding("the predicted horizontal deviation", sigma, max_sigma, " m");
  // Each scan sees its own side of things; the error that all correspondences share may be as large as what
  // is left.
  const double residual = std::sqrt(icp.variance);
  if (residual > max_sigma)
    return exceeding("the distance left between the surfaces", residual, max_sigma, " m");
  return {};
}

Alignment refused(const ScanPair& pair, const std::string& reason) {
  Alignment result;
  result.reference_from_moving = pair.initialGuess();
  result.overlap = overlapOf(pair, Eigen::Isometry3d::Identity());
  result.refusal = reason;
  return result;
}

Alignment alignmentOf(const ScanPair& pair, const IcpResult& icp, AlignmentMethod method) {
  Alignment result;
  result.method = method;
  result.reference_from_moving = icp.correction * pair.initialGuess();
  result.overlap = overlapOf(pair, icp.correction);
  const std::optional<Matrix6d> covariance = covarianceAboutCentre(icp);
  if (covariance) result.covariance = covarianceAboutOrigin(*covariance, icp.centre);
  return result;
}

}  // namespace pcl_fft_ground::core
