#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace pcl_fft_ground::core {

/// By how many standard deviations the poses contradict an edge, squared.
double squaredDeviation(const PoseGraphEdge& edge, const std::vector<Eigen::Isometry3d>& poses);

/// The normal equations of a pose graph, linearised at given poses. Unknowns: a twist for each node, applied
/// in the node's own frame.
class PoseGraphEquations {
 public:
  PoseGraphEquations(const std::vector<Eigen::Isometry3d>& poses, const std::vector<PoseGraphEdge>& edges,
                     const std::vector<double>& weights, const std::vector<PosePrior>& priors);

  Eigen::SparseMatrix<double> matrix() const;
  const Eigen::VectorXd& rightHandSide() const { return right_; }

 private:
  void add(const PoseGraphEdge& edge, double weight, const std::vector<Eigen::Isometry3d>& poses);
  void add(const PosePrior& prior, const std::vector<Eigen::Isometry3d>& poses);
  void addBlock(std::size_t row_node, std::size_t column_node, const MotionCovariance& block);

  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd right_;
};

}  // namespace pcl_fft_ground::core
