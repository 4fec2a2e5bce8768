#include "survey/pose_graph_equations.h"

#include <Eigen/Cholesky>

#include "align/rigid_motion.h"

namespace pcl_fft_ground::core {

namespace {

TwistMatrix informationOf(const MotionCovariance& covariance) {
  return covariance.llt().solve(TwistMatrix::Identity());
}

/// The error of an edge: the motion in the reference's frame by which the poses differ from what it says.
Twist errorOf(const PoseGraphEdge& edge, const std::vector<Eigen::Isometry3d>& poses) {
  return twistOf(poses[edge.reference].inverse() * poses[edge.moving] * edge.reference_from_moving.inverse());
}

Eigen::Index unknownsOf(std::size_t node) {
  return static_cast<Eigen::Index>(6 * node);
}

}  // namespace

double squaredDeviation(const PoseGraphEdge& edge, const std::vector<Eigen::Isometry3d>& poses) {
  const Twist error = errorOf(edge, poses);
  return error.dot(informationOf(edge.covariance) * error);
}

PoseGraphEquations::PoseGraphEquations(const std::vector<Eigen::Isometry3d>& poses,
                                       const std::vector<PoseGraphEdge>& edges,
                                       const std::vector<double>& weights,
                                       const std::vector<PosePrior>& priors)
    : right_(Eigen::VectorXd::Zero(unknownsOf(poses.size()))) {
  for (std::size_t i = 0; i < edges.size(); ++i) add(edges[i], weights[i], poses);
  for (const PosePrior& prior : priors) add(prior, poses);
}

Eigen::SparseMatrix<double> PoseGraphEquations::matrix() const {
  Eigen::SparseMatrix<double> result(right_.size(), right_.size());
  result.setFromTriplets(entries_.begin(), entries_.end());
  return result;
}

void PoseGraphEquations::add(const PoseGraphEdge& edge, double weight,
                             const std::vector<Eigen::Isometry3d>& poses) {
  const Twist error = errorOf(edge, poses);
  const TwistMatrix by_reference = -rightInverseJacobian(-error);
  const TwistMatrix by_moving = rightInverseJacobian(error) * adjoint(edge.reference_from_moving);
  const TwistMatrix information = weight * informationOf(edge.covariance);
  addBlock(edge.reference, edge.reference, by_reference.transpose() * information * by_reference);
  addBlock(edge.reference, edge.moving, by_reference.transpose() * information * by_moving);
  addBlock(edge.moving, edge.reference, by_moving.transpose() * information * by_reference);
  addBlock(edge.moving, edge.moving, by_moving.transpose() * information * by_moving);
  right_.segment<6>(unknownsOf(edge.reference)) -= by_reference.transpose() * information * error;
  right_.segment<6>(unknownsOf(edge.moving)) -= by_moving.transpose() * information * error;
}

void PoseGraphEquations::add(const PosePrior& prior, const std::vector<Eigen::Isometry3d>& poses) {
  const Twist error = twistOf(prior.world_from_node.inverse() * poses[prior.node]);
  const TwistMatrix by_node = rightInverseJacobian(error);
  const TwistMatrix information = informationOf(prior.covariance);
  addBlock(prior.node, prior.node, by_node.transpose() * information * by_node);
  right_.segment<6>(unknownsOf(prior.node)) -= by_node.transpose() * information * error;
}

void PoseGraphEquations::addBlock(std::size_t row_node, std::size_t column_node,
                                  const MotionCovariance& block) {
  for (Eigen::Index j = 0; j < 6; ++j) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      entries_.emplace_back(unknownsOf(row_node) + i, unknownsOf(column_node) + j, block(i, j));
    }
  }
}

}  // namespace pcl_fft_ground::core
