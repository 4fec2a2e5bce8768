#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pcl_fft_ground/core/align/rigid_fit.h"
#include "pcl_fft_ground/core/export.h"

namespace pcl_fft_ground::core {

/// Covariance of (translation [m], rotation vector [rad]) of a small motion.
using MotionCovariance = Matrix6d;

/// How one sub-map lies to another, as an alignment of the two has it.
struct PoseGraphEdge {
  std::size_t reference = 0;
  std::size_t moving = 0;
  Eigen::Isometry3d reference_from_moving = Eigen::Isometry3d::Identity();
  /// Of the error, a motion in the reference's frame applied after the transform; positive definite.
  MotionCovariance covariance = MotionCovariance::Identity();
};

/// Where navigation has a sub-map.
struct PosePrior {
  std::size_t node = 0;
  Eigen::Isometry3d world_from_node = Eigen::Isometry3d::Identity();
  /// Of the error, a motion in the sub-map's own frame applied before the transform; positive definite.
  MotionCovariance covariance = MotionCovariance::Identity();
};

/// Settings of solvePoseGraph().
struct PoseGraphParameters {
  /// Deviation of an edge, in standard deviations of all its six parts together, at which it counts a
  /// quarter: wrong edges hardly count at all. Above 0; infinity: all edges count fully.
  double outlier_deviation = 8.0;
  unsigned max_iterations = 100;  ///< of Gauss-Newton, at least 1
};

/// The poses of a survey as a whole.
struct PoseGraphSolution {
  std::vector<Eigen::Isometry3d> world_from_node;
  std::vector<double> edge_weights;  ///< per edge how much it counted, 0 to 1
  bool converged = false;            ///< whether the last step was below a micrometre and a microradian
};

/** \brief The edges that agree with each other: a set of which no cycle is open, as large as it can be found.
 *
 * Edges that lead from a node back to it have to end where they began. A cycle of two to four edges is open
 * if it does not, by more than `outlier_deviation` standard deviations an edge. One of its edges then is
 * wrong: that of which most cycles are open goes first, until none is left; then those come back that
 * contradict none of the rest. So a set of wrong edges that agree with each other, but with fewer others than
 * those they contradict, goes as a whole, where a kernel would judge each by itself. (Mangelson et al.,
 * "Pairwise consistent measurement set maximization", 2018, compare two edges by odometry that is trusted;
 * here no edge is, and cycles vote.) Edges in no cycle stay.
 *
 * \return per edge whether it stays
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<bool> consistentEdges(const std::vector<PoseGraphEdge>& edges,
                                                             double outlier_deviation = 8.0);

/** \brief Poses that agree best with all edges and priors: nonlinear least squares on SE(3).
 *
 * Gauss-Newton with a sparse Cholesky decomposition. Edges count by Geman-McClure's robust kernel, which is
 * made gradually less convex (Yang et al., "Graduated non-convexity for robust spatial perception", 2020), so
 * that a wrong edge loses its say whatever the start.
 *
 * \param start poses to start from, one per node
 * \param priors at least one for each part of the graph that edges hold together
 * \throws std::invalid_argument for an index without a node, a covariance that is not positive definite, or a
 *         parameter out of range
 * \throws std::runtime_error where priors and edges do not determine all poses
 */
PCL_FFT_GROUND_CORE_EXPORT PoseGraphSolution solvePoseGraph(const std::vector<Eigen::Isometry3d>& start,
                                                            const std::vector<PoseGraphEdge>& edges,
                                                            const std::vector<PosePrior>& priors,
                                                            const PoseGraphParameters& parameters = {});

/** \brief How sure the poses of a solution are.
 * \param solution solvePoseGraph() of the edges and priors
 * \return per node the covariance of a motion in its own frame applied before the transform, by the
 * covariances of edges and priors as they are weighed; nothing where these do not determine all poses \note
 * One solution of the equations a node: of thousands of poses it takes longer than these themselves.
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<MotionCovariance> poseCovariances(
    const PoseGraphSolution& solution, const std::vector<PoseGraphEdge>& edges,
    const std::vector<PosePrior>& priors);

}  // namespace pcl_fft_ground::core
