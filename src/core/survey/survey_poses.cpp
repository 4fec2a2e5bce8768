#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "align/rigid_motion.h"
#include "pcl_fft_ground/core/survey/survey.h"
#include "pcl_fft_ground/core/survey/survey_tables.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double DEGREE = static_cast<double>(EIGEN_PI / 180);
// What the covariance of an alignment knows nothing of: a scan is not quite rigid.
constexpr double MODEL_TRANSLATION = 0.004;  // [m]
constexpr double MODEL_ROTATION = 0.08 * DEGREE;
// A newcomer's place in a survey under way.
constexpr int REFINED_EDGES = 2;  // from it to the scans whose poses are refined
constexpr double CONTRADICTED_WEIGHT =
    0.5;  // of its edge, 5 deviations off: the map has to give way elsewhere
constexpr double FIXED_TRANSLATION = 1e-4;  // deviation of what stays where it is [m]
constexpr double FIXED_ROTATION = 1e-5;     // [rad]
constexpr double REJECTED_WEIGHT = 0.25;    // an edge that counts less is taken for false

std::vector<Eigen::Isometry3d> navigationOf(const std::vector<SurveyScan>& scans) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(scans.size());
  for (const SurveyScan& scan : scans) poses.push_back(scan.world_from_scan);
  return poses;
}

MotionCovariance diagonalCovariance(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  MotionCovariance covariance = MotionCovariance::Zero();
  covariance.diagonal() << translation.cwiseAbs2(), rotation.cwiseAbs2();
  return covariance;
}

PosePrior priorOf(std::size_t number, const SurveyScan& scan) {
  const NavigationSigmas& s = scan.sigmas;
  const double tilt = s.tilt * DEGREE;
  return {number, scan.world_from_scan,
          diagonalCovariance({s.horizontal, s.horizontal, s.vertical}, {tilt, tilt, s.heading * DEGREE})};
}

PoseGraphEdge edgeOf(const PairResult& result) {
  const MotionCovariance model = diagonalCovariance(Eigen::Vector3d::Constant(MODEL_TRANSLATION),
                                                    Eigen::Vector3d::Constant(MODEL_ROTATION));
  return {result.reference, result.moving, result.reference_from_moving, result.covariance + model};
}

std::vector<PoseGraphEdge> edgesOf(const std::vector<PairResult>& results, const std::string& method) {
  std::vector<PoseGraphEdge> edges;
  for (const PairResult& result : results)
    if (result.method == method && result.status == PairStatus::ALIGNED) edges.push_back(edgeOf(result));
  return edges;
}

std::vector<PoseGraphEdge> consistentOf(const std::vector<PoseGraphEdge>& edges) {
  const std::vector<bool> is_consistent = consistentEdges(edges);
  std::vector<PoseGraphEdge> kept;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (is_consistent[e]) kept.push_back(edges[e]);
  return kept;
}

/// A part of a survey as a pose graph of its own.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<SurveyScan>& scans, const std::vector<PairResult>& results,
                const std::vector<Eigen::Isometry3d>& poses)
      : scans_(scans), results_(results), poses_(poses), node_of_(scans.size()) {}

  /// Adds a scan that is to be solved for, and all that are so many edges from it or nearer.
  void addFree(std::size_t scan, int edges) {
    addNode(scan);
    for (; edges > 0; --edges) {
      const std::vector<std::size_t> known = nodes_;
      for (const std::size_t one : known)
        for (const std::size_t other : neighboursOf(one)) addNode(other);
    }
    free_ = nodes_.size();
  }

  /// Solves for the free scans. Those that these have edges to stay where they are.
  RefinedPoses solve(std::size_t newcomer) {
    for (std::size_t n = 0; n < free_; ++n)
      for (const std::size_t other : neighboursOf(nodes_[n])) addNode(other);
    std::vector<Eigen::Isometry3d> start;
    std::vector<PosePrior> priors;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      start.push_back(poses_[nodes_[n]]);
      priors.push_back(n < free_ ? priorOf(n, scans_[nodes_[n]]) : PosePrior{n, start.back(), fixed()});
    }
    const std::vector<const PairResult*> pairs = pairsWithin();
    std::vector<PoseGraphEdge> edges;
    for (const PairResult* pair : pairs) {
      edges.push_back(edgeOf(*pair));
      edges.back().reference = *node_of_[pair->reference];
      edges.back().moving = *node_of_[pair->moving];
    }
    const PoseGraphSolution solution = solvePoseGraph(start, edges, priors);
    RefinedPoses refined{poses_, false};
    for (std::size_t n = 0; n < free_; ++n) refined.poses[nodes_[n]] = solution.world_from_node[n];
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (pairs[e]->moving == newcomer && solution.edge_weights[e] < CONTRADICTED_WEIGHT)
        refined.contradicted = true;
    return refined;
  }

 private:
  static MotionCovariance fixed() {
    return diagonalCovariance(Eigen::Vector3d::Constant(FIXED_TRANSLATION),
                              Eigen::Vector3d::Constant(FIXED_ROTATION));
  }

  void addNode(std::size_t scan) {
    if (node_of_[scan]) return;
    node_of_[scan] = nodes_.size();
    nodes_.push_back(scan);
  }

  std::vector<std::size_t> neighboursOf(std::size_t scan) const {
    std::vector<std::size_t> neighbours;
    for (const PairResult& result : results_) {
      if (result.status != PairStatus::ALIGNED) continue;
      if (result.reference == scan) neighbours.push_back(result.moving);
      if (result.moving == scan) neighbours.push_back(result.reference);
    }
    return neighbours;
  }

  /// The aligned pairs with a free scan.
  std::vector<const PairResult*> pairsWithin() const {
    std::vector<const PairResult*> pairs;
    for (const PairResult& result : results_) {
      const std::optional<std::size_t> a = node_of_[result.reference], b = node_of_[result.moving];
      if (result.status == PairStatus::ALIGNED && a && b && (*a < free_ || *b < free_))
        pairs.push_back(&result);
    }
    return pairs;
  }

  const std::vector<SurveyScan>& scans_;
  const std::vector<PairResult>& results_;
  const std::vector<Eigen::Isometry3d>& poses_;
  std::vector<std::optional<std::size_t>> node_of_;  // by scan, where it takes part
  std::vector<std::size_t> nodes_;                   // the free ones first
  std::size_t free_ = 0;
};

/// Each scan placed by the pair of the chain that comes to it first; where that was refused, by navigation.
std::vector<Eigen::Isometry3d> chainPoses(const std::vector<Eigen::Isometry3d>& navigation,
                                          const std::vector<PairResult>& results, const std::string& method) {
  std::vector<Eigen::Isometry3d> poses = navigation;
  std::vector<bool> placed(poses.size(), false);
  if (!placed.empty()) placed[0] = true;
  for (const PairResult& result : results) {
    if (result.method != method || result.kind != PairKind::CHAIN || placed[result.moving]) continue;
    poses[result.moving] = poses[result.reference] * result.reference_from_moving;
    placed[result.moving] = true;
  }
  return poses;
}

/// Places fixed to the scans, one per column. \param offset from the middle of each, in its own frame [m]
Eigen::Matrix3Xd placesAt(const Eigen::Vector3d& offset, const std::vector<SurveyScan>& scans,
                          const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = poses[i] * (scans[i].centroid + offset);
  return places;
}

/// The motion that lays poses on the truth. By three places of each scan, since the middles of those along
/// one transect would leave the turn about it free.
Eigen::Isometry3d truthFrom(const std::vector<SurveyScan>& scans, const std::vector<Eigen::Isometry3d>& truth,
                            const std::vector<Eigen::Isometry3d>& poses) {
  const auto count = static_cast<Eigen::Index>(poses.size());
  Eigen::Matrix3Xd places(3, 3 * count), true_places(3, 3 * count);
  const std::array<Eigen::Vector3d, 3> offsets{
      {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()}};
  for (Eigen::Index n = 0; n < 3; ++n) {
    const Eigen::Vector3d& offset = offsets[static_cast<std::size_t>(n)];
    places.middleCols(n * count, count) = placesAt(offset, scans, poses);
    true_places.middleCols(n * count, count) = placesAt(offset, scans, truth);
  }
  return Eigen::Isometry3d(Eigen::umeyama(places, true_places, false));
}

}  // namespace

SurveyPoses solveSurvey(const std::vector<SurveyScan>& scans, const std::vector<PairResult>& results,
                        const std::string& method) {
  SurveyPoses poses;
  poses.navigation = navigationOf(scans);
  poses.chained = chainPoses(poses.navigation, results, method);
  const std::vector<PoseGraphEdge> all = edgesOf(results, method);
  const std::vector<PoseGraphEdge> edges = consistentOf(all);
  std::vector<PosePrior> priors;
  for (std::size_t i = 0; i < scans.size(); ++i) priors.push_back(priorOf(i, scans[i]));
  const PoseGraphSolution solution = solvePoseGraph(poses.navigation, edges, priors);
  poses.global = solution.world_from_node;
  poses.edges = all.size();
  poses.rejected_edges =
      all.size() - edges.size() +
      static_cast<std::size_t>(std::count_if(solution.edge_weights.begin(), solution.edge_weights.end(),
                                             [](double weight) { return weight < REJECTED_WEIGHT; }));
  return poses;
}

RefinedPoses refineAround(std::size_t newcomer, const std::vector<SurveyScan>& scans,
                          const std::vector<PairResult>& results,
                          const std::vector<Eigen::Isometry3d>& poses) {
  Neighbourhood neighbourhood(scans, results, poses);
  neighbourhood.addFree(newcomer, REFINED_EDGES);
  return neighbourhood.solve(newcomer);
}

PoseErrors poseErrors(const std::vector<SurveyScan>& scans, const std::vector<Eigen::Isometry3d>& truth,
                      const std::vector<Eigen::Isometry3d>& poses) {
  const Eigen::Isometry3d truth_from_poses = truthFrom(scans, truth, poses);
  const Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const Eigen::VectorXd distances =
      (truth_from_poses * placesAt(middle, scans, poses) - placesAt(middle, scans, truth)).colwise().norm();
  std::vector<double> turns;
  for (std::size_t i = 0; i < poses.size(); ++i)
    turns.push_back(angleBetween(truth[i], truth_from_poses * poses[i]) / DEGREE);
  return {poses.size(), std::sqrt(distances.squaredNorm() / static_cast<double>(distances.size())),
          distances.maxCoeff(), *quantileOf(turns, 0.5)};
}

PoseErrors pooled(const std::vector<PoseErrors>& errors) {
  PoseErrors all;
  double squares = 0;
  std::vector<double> turns;
  for (const PoseErrors& one : errors) {
    squares += static_cast<double>(one.scans) * one.rms_translation * one.rms_translation;
    all.scans += one.scans;
    all.max_translation = std::max(all.max_translation, one.max_translation);
    turns.push_back(one.median_rotation);
  }
  all.rms_translation = std::sqrt(squares / static_cast<double>(all.scans));
  all.median_rotation = quantileOf(turns, 0.5).value_or(0);
  return all;
}

}  // namespace pcl_fft_ground::core
