#include "pcl_fft_ground/core/survey/pose_graph.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "align/rigid_motion.h"
#include "survey/pose_graph_equations.h"

namespace pcl_fft_ground::core {

namespace {

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
  constexpr double kTightening = 1.4;  // of the kernel per iteration, until it has its own width
  constexpr double kSmallStep = 1e-6;  // [m], [rad]
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
      const Twist motion = step.segment<6>(static_cast<Eigen::Index>(6 * n));
      solution.world_from_node[n] = solution.world_from_node[n] * motionOf(motion);
    }
    const bool is_final_kernel = widening <= 1.0;
    widening = std::max(1.0, widening / kTightening);
    solution.converged = is_final_kernel && step.cwiseAbs().maxCoeff() < kSmallStep;
  }
  return solution;
}

}  // namespace pcl_fft_ground::core
