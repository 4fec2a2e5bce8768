#include "pcl_fft_ground/core/survey/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "align/rigid_motion.h"

namespace pcl_fft_ground::core {

namespace {

Matrix6d informationOf(const MotionCovariance& covariance) {
  return covariance.llt().solve(Matrix6d::Identity());
}

/// The error of an edge: the motion in the reference's frame by which the poses differ from what it says.
Vector6d errorOf(const PoseGraphEdge& edge, const std::vector<Eigen::Isometry3d>& poses) {
  return twistOf(poses[edge.reference].inverse() * poses[edge.moving] * edge.reference_from_moving.inverse());
}

Eigen::Index unknownsOf(std::size_t node) {
  return static_cast<Eigen::Index>(6 * node);
}

/// By how many standard deviations the poses contradict an edge, squared.
double squaredDeviation(const PoseGraphEdge& edge, const std::vector<Eigen::Isometry3d>& poses) {
  const Vector6d error = errorOf(edge, poses);
  return error.dot(informationOf(edge.covariance) * error);
}

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
  const Vector6d error = errorOf(edge, poses);
  const Matrix6d by_reference = -rightInverseJacobian(-error);
  const Matrix6d by_moving = rightInverseJacobian(error) * adjoint(edge.reference_from_moving);
  const Matrix6d information = weight * informationOf(edge.covariance);
  addBlock(edge.reference, edge.reference, by_reference.transpose() * information * by_reference);
  addBlock(edge.reference, edge.moving, by_reference.transpose() * information * by_moving);
  addBlock(edge.moving, edge.reference, by_moving.transpose() * information * by_reference);
  addBlock(edge.moving, edge.moving, by_moving.transpose() * information * by_moving);
  right_.segment<6>(unknownsOf(edge.reference)) -= by_reference.transpose() * information * error;
  right_.segment<6>(unknownsOf(edge.moving)) -= by_moving.transpose() * information * error;
}

void PoseGraphEquations::add(const PosePrior& prior, const std::vector<Eigen::Isometry3d>& poses) {
  const Vector6d error = twistOf(prior.world_from_node.inverse() * poses[prior.node]);
  const Matrix6d by_node = rightInverseJacobian(error);
  const Matrix6d information = informationOf(prior.covariance);
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

void requireNode(std::size_t node, std::size_t count) {
  if (node >= count) throw std::invalid_argument("solvePoseGraph: there is no node " + std::to_string(node));
}

void requireCovariance(const MotionCovariance& covariance) {
  const Eigen::LLT<MotionCovariance> cholesky(covariance);
  if (!covariance.allFinite() || cholesky.info() != Eigen::Success) {
    throw std::invalid_argument("solvePoseGraph: a covariance is not positive definite");
  }
}

void validate(std::size_t nodes, const std::vector<PoseGraphEdge>& edges,
              const std::vector<PosePrior>& priors, const PoseGraphParameters& parameters) {
  for (const PoseGraphEdge& edge : edges) {
    requireNode(edge.reference, nodes);
    requireNode(edge.moving, nodes);
    requireCovariance(edge.covariance);
    if (edge.reference == edge.moving)
      throw std::invalid_argument("solvePoseGraph: an edge joins a node to itself");
  }
  for (const PosePrior& prior : priors) {
    requireNode(prior.node, nodes);
    requireCovariance(prior.covariance);
  }
  if (!(parameters.outlier_deviation > 0.0)) {
    throw std::invalid_argument("solvePoseGraph: outlier_deviation must be above 0");
  }
  if (parameters.max_iterations < 1)
    throw std::invalid_argument("solvePoseGraph: max_iterations must be at least 1");
}

/// How much an edge of this squared deviation counts. \param scale squared deviation at which it counts a
/// quarter
double gemanMcClure(double squared_deviation, double scale) {
  if (std::isinf(scale)) return 1.0;
  const double share = scale / (scale + squared_deviation);
  return share * share;
}

/// The weight of every edge at these poses.
std::vector<double> weightsOf(const std::vector<PoseGraphEdge>& edges,
                              const std::vector<Eigen::Isometry3d>& poses, double scale) {
  std::vector<double> weights;
  weights.reserve(edges.size());
  for (const PoseGraphEdge& edge : edges)
    weights.push_back(gemanMcClure(squaredDeviation(edge, poses), scale));
  return weights;
}

double largestDeviation(const std::vector<PoseGraphEdge>& edges,
                        const std::vector<Eigen::Isometry3d>& poses) {
  double largest = 0.0;
  for (const PoseGraphEdge& edge : edges) largest = std::max(largest, squaredDeviation(edge, poses));
  return largest;
}

/// The motion of each node, in its own frame, that solves the linearised problem; six numbers a node.
Eigen::VectorXd gaussNewtonStep(const PoseGraphEquations& equations) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(equations.matrix());
  const Eigen::VectorXd pivots =
      cholesky.info() == Eigen::Success ? cholesky.vectorD() : Eigen::VectorXd::Zero(1);
  if (!(pivots.minCoeff() > 0.0)) throw std::runtime_error("priors and edges do not determine all poses");
  return cholesky.solve(equations.rightHandSide());
}

}  // namespace

PoseGraphSolution solvePoseGraph(const std::vector<Eigen::Isometry3d>& start,
                                 const std::vector<PoseGraphEdge>& edges,
                                 const std::vector<PosePrior>& priors,
                                 const PoseGraphParameters& parameters) {
  constexpr double TIGHTENING = 1.4;   // of the kernel per iteration, until it has its own width
  constexpr double SMALL_STEP = 1e-6;  // [m], [rad]
  validate(start.size(), edges, priors, parameters);
  PoseGraphSolution solution;
  solution.world_from_node = start;
  solution.converged = start.empty();
  const double scale = parameters.outlier_deviation * parameters.outlier_deviation;
  double widening = std::max(1.0, 2.0 * largestDeviation(edges, start) / scale);
  for (unsigned i = 0; i < parameters.max_iterations && !solution.converged; ++i) {
    solution.edge_weights = weightsOf(edges, solution.world_from_node, widening * scale);
    const Eigen::VectorXd step =
        gaussNewtonStep(PoseGraphEquations(solution.world_from_node, edges, solution.edge_weights, priors));
    for (std::size_t n = 0; n < start.size(); ++n) {
      const Vector6d motion = step.segment<6>(static_cast<Eigen::Index>(6 * n));
      solution.world_from_node[n] = solution.world_from_node[n] * motionOf(motion);
    }
    const bool is_final_kernel = widening <= 1.0;
    widening = std::max(1.0, widening / TIGHTENING);
    solution.converged = is_final_kernel && step.cwiseAbs().maxCoeff() < SMALL_STEP;
  }
  return solution;
}

/// The blocks of the inverse on the diagonal.
std::vector<MotionCovariance> poseCovariances(const PoseGraphSolution& solution,
                                              const std::vector<PoseGraphEdge>& edges,
                                              const std::vector<PosePrior>& priors) {
  const PoseGraphEquations equations(solution.world_from_node, edges, solution.edge_weights, priors);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(equations.matrix());
  std::vector<MotionCovariance> covariances;
  if (cholesky.info() != Eigen::Success || !(cholesky.vectorD().minCoeff() > 0)) return covariances;
  const Eigen::Index unknowns = equations.rightHandSide().size();
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(unknowns, 6);
  for (Eigen::Index first = 0; first < unknowns; first += 6) {
    unit.middleRows<6>(first).setIdentity();
    covariances.push_back(cholesky.solve(unit).middleRows<6>(first));
    unit.middleRows<6>(first).setZero();
  }
  return covariances;
}

}  // namespace pcl_fft_ground::core
