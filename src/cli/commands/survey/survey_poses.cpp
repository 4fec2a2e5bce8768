#include "commands/survey/survey_poses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "commands/survey/survey_table.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double DEGREE = EIGEN_PI / 180;
// What navigation measures directly: pressure and gravity.
constexpr double DEPTH_DEVIATION = 0.05;  // [m]
constexpr double TILT_DEVIATION = 0.5 * DEGREE;
// What the covariance of an alignment knows nothing of: a sub-map is not quite rigid.
constexpr double MODEL_TRANSLATION = 0.004;  // [m]
constexpr double MODEL_ROTATION = 0.08 * DEGREE;

core::MotionCovariance diagonalCovariance(const Eigen::Vector3d& translation,
                                          const Eigen::Vector3d& rotation) {
  core::MotionCovariance covariance = core::MotionCovariance::Zero();
  covariance.diagonal() << translation.cwiseAbs2(), rotation.cwiseAbs2();
  return covariance;
}

std::vector<core::PosePrior> priorsOf(const std::vector<Eigen::Isometry3d>& navigation,
                                      const NavigationTrust& trust) {
  const core::MotionCovariance covariance =
      diagonalCovariance({trust.horizontal, trust.horizontal, DEPTH_DEVIATION},
                         {TILT_DEVIATION, TILT_DEVIATION, trust.heading * DEGREE});
  std::vector<core::PosePrior> priors;
  for (std::size_t i = 0; i < navigation.size(); ++i) priors.push_back({i, navigation[i], covariance});
  return priors;
}

bool isEdge(const PairResult& result, const std::string& mapping) {
  return result.method == mapping && result.status == PairStatus::ALIGNED;
}

std::vector<core::PoseGraphEdge> edgesOf(const std::vector<PairResult>& results, const std::string& mapping) {
  const core::MotionCovariance model = diagonalCovariance(Eigen::Vector3d::Constant(MODEL_TRANSLATION),
                                                          Eigen::Vector3d::Constant(MODEL_ROTATION));
  std::vector<core::PoseGraphEdge> edges;
  for (const PairResult& result : results)
    if (isEdge(result, mapping))
      edges.push_back(
          {result.reference, result.moving, result.reference_from_moving, result.covariance + model});
  return edges;
}

/// Each sub-map placed by the pair of the chain that comes to it first; where that was refused, by
/// navigation.
std::vector<Eigen::Isometry3d> chainPoses(const std::vector<Eigen::Isometry3d>& navigation,
                                          const std::vector<PairResult>& results,
                                          const std::string& mapping) {
  std::vector<Eigen::Isometry3d> poses = navigation;
  std::vector<bool> placed(poses.size(), false);
  if (!placed.empty()) placed[0] = true;
  for (const PairResult& result : results) {
    if (result.method != mapping || result.kind != PairKind::CHAIN || placed[result.moving]) continue;
    poses[result.moving] = poses[result.reference] * result.reference_from_moving;
    placed[result.moving] = true;
  }
  return poses;
}

/// Places fixed to the sub-maps, one per column. \param offset from the middle of each, in its own frame [m]
Eigen::Matrix3Xd placesAt(const Eigen::Vector3d& offset, const SurveyFolder& survey,
                          const std::vector<Eigen::Isometry3d>& poses) {
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = poses[i] * (survey.submaps[i].centroid + offset);
  return places;
}

/// The motion that lays poses on the truth. By three places of each sub-map, since the middles of those along
/// one transect would leave the turn about it free.
Eigen::Isometry3d truthFrom(const SurveyFolder& survey, const std::vector<Eigen::Isometry3d>& poses) {
  const auto count = static_cast<Eigen::Index>(poses.size());
  Eigen::Matrix3Xd places(3, 3 * count), true_places(3, 3 * count);
  const std::array<Eigen::Vector3d, 3> offsets{
      {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()}};
  for (Eigen::Index n = 0; n < 3; ++n) {
    const Eigen::Vector3d& offset = offsets[static_cast<std::size_t>(n)];
    places.middleCols(n * count, count) = placesAt(offset, survey, poses);
    true_places.middleCols(n * count, count) = placesAt(offset, survey, survey.truth);
  }
  return Eigen::Isometry3d(Eigen::umeyama(places, true_places, false));
}

}  // namespace

SurveyPoses solveSurvey(const SurveyFolder& survey, const std::vector<PairResult>& results,
                        const std::string& mapping, const NavigationTrust& trust) {
  SurveyPoses poses;
  for (const Submap& submap : survey.submaps) poses.navigation.push_back(submap.navigation);
  poses.chained = chainPoses(poses.navigation, results, mapping);
  const std::vector<core::PoseGraphEdge> edges = edgesOf(results, mapping);
  const core::PoseGraphSolution solution =
      core::solvePoseGraph(poses.navigation, edges, priorsOf(poses.navigation, trust));
  poses.global = solution.world_from_node;
  poses.edges = edges.size();
  poses.rejected_edges =
      static_cast<std::size_t>(std::count_if(solution.edge_weights.begin(), solution.edge_weights.end(),
                                             [](double weight) { return weight < 0.25; }));
  return poses;
}

PoseErrors poseErrors(const SurveyFolder& survey, const std::vector<Eigen::Isometry3d>& poses) {
  const Eigen::Isometry3d truth_from_poses = truthFrom(survey, poses);
  const Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const Eigen::VectorXd distances =
      (truth_from_poses * placesAt(middle, survey, poses) - placesAt(middle, survey, survey.truth))
          .colwise()
          .norm();
  std::vector<double> turns;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix3d turn =
        survey.truth[i].linear().transpose() * (truth_from_poses * poses[i]).linear();
    turns.push_back(Eigen::AngleAxisd(turn).angle() / DEGREE);
  }
  return {std::sqrt(distances.squaredNorm() / static_cast<double>(distances.size())), distances.maxCoeff(),
          *quantileOf(turns, 0.5)};
}

nlohmann::ordered_json asJson(const PoseErrors& errors) {
  return {{"translation_rms", errors.rms_translation},
          {"translation_max", errors.max_translation},
          {"rotation_median_degrees", errors.median_rotation}};
}

}  // namespace pcl_fft_ground::cli
