#include "pcl_fft_ground/core/survey/pose_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace pcl_fft_ground::core {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

Eigen::Isometry3d motion(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(rotation / angle) : Eigen::Vector3d::UnitZ();
  return Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle, axis);
}

MotionCovariance covariance(double translation, double rotation) {
  MotionCovariance result = MotionCovariance::Zero();
  result.diagonal().head<3>().setConstant(translation * translation);
  result.diagonal().tail<3>().setConstant(rotation * rotation);
  return result;
}

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

/// Largest distance between poses of two surveys after the first poses are laid on each other [m].
double shapeError(const Poses& a, const Poses& b) {
  const Eigen::Isometry3d a_from_b = a[0] * b[0].inverse();
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], a_from_b * b[i]));
  return largest;
}

/// A survey of 12 sub-maps on three transects; each is joined to the next and to its neighbour across.
class PoseGraph : public testing::TestWithParam<unsigned> {
 protected:
  PoseGraph() : generator_(GetParam()) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        const Eigen::Vector3d place(2.4 * column, 2.0 * row, 0.1 * row);
        truth_.push_back(motion(place, {0.02, -0.01, row % 2 == 0 ? 0.05 : 3.1}));
      }
    }
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      navigation_.push_back(truth_[i] * disturbance(0.1, 0.03));
      priors_.push_back({i, navigation_[i], covariance(0.1, 0.03)});
      for (const std::size_t step : {1, 4})
        if (i + step < truth_.size()) join(i, i + step);
    }
  }

  Eigen::Isometry3d disturbance(double translation, double rotation) {
    std::normal_distribution<double> normal;
    const auto vector = [&](double scale) {
      const double x = normal(generator_), y = normal(generator_), z = normal(generator_);
      return Eigen::Vector3d(scale * Eigen::Vector3d(x, y, z));
    };
    const Eigen::Vector3d shift = vector(translation);
    return motion(shift, vector(rotation));
  }

  void join(std::size_t reference, std::size_t moving) {
    const Eigen::Isometry3d exact = truth_[reference].inverse() * truth_[moving];
    edges_.push_back({reference, moving, disturbance(0.002, 0.0005) * exact, covariance(0.002, 0.0005)});
  }

  std::mt19937 generator_;
  Poses truth_, navigation_;
  std::vector<PoseGraphEdge> edges_;
  std::vector<PosePrior> priors_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, PoseGraph, testing::Values(1U, 2U, 3U, 4U));

TEST_P(PoseGraph, ExactEdgesGiveTheExactShape) {
  for (PoseGraphEdge& edge : edges_)
    edge.reference_from_moving = truth_[edge.reference].inverse() * truth_[edge.moving];
  for (PosePrior& prior : priors_) prior.covariance *= 1e6;
  const PoseGraphSolution solution = solvePoseGraph(navigation_, edges_, priors_);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(shapeError(truth_, solution.world_from_node), 1e-6);
  for (const double weight : solution.edge_weights) EXPECT_GT(weight, 0.999);
}

TEST_P(PoseGraph, NoisyEdgesGiveNearlyTheShapeAndNavigationThePlace) {
  const PoseGraphSolution solution = solvePoseGraph(navigation_, edges_, priors_);
  EXPECT_TRUE(solution.converged);
  EXPECT_LT(shapeError(truth_, solution.world_from_node), 0.02);
  double mean_error = 0;
  for (std::size_t i = 0; i < truth_.size(); ++i)
    mean_error += distance(truth_[i], solution.world_from_node[i]) / static_cast<double>(truth_.size());
  EXPECT_LT(mean_error, 0.12);  // sqrt(3) times 0.1 m over the root of 12, and its turn
}

TEST_P(PoseGraph, OneFalseEdgeDoesNoHarm) {
  const double without = shapeError(truth_, solvePoseGraph(navigation_, edges_, priors_).world_from_node);
  edges_.push_back({2, 9, motion({0.4, -0.3, 0.1}, {0, 0, 0.2}) * truth_[2].inverse() * truth_[9],
                    covariance(0.002, 0.0005)});
  const PoseGraphSolution solution = solvePoseGraph(navigation_, edges_, priors_);
  EXPECT_LT(solution.edge_weights.back(), 0.01);
  EXPECT_LT(shapeError(truth_, solution.world_from_node), without + 0.001);

  PoseGraphParameters trusting;
  trusting.outlier_deviation = std::numeric_limits<double>::infinity();
  EXPECT_GT(shapeError(truth_, solvePoseGraph(navigation_, edges_, priors_, trusting).world_from_node), 0.1);
}

TEST_P(PoseGraph, TheSolutionIsTheLeastOfTheCost) {
  PoseGraphParameters trusting;
  trusting.outlier_deviation = std::numeric_limits<double>::infinity();
  const PoseGraphSolution solution = solvePoseGraph(navigation_, edges_, priors_, trusting);
  // Squared deviations from definitions: small motions, so that a rotation vector is the axis times the
  // angle.
  const auto twist = [](const Eigen::Isometry3d& m) {
    const Eigen::AngleAxisd turn(m.linear());
    Eigen::Matrix<double, 6, 1> result;
    result << m.translation(), turn.angle() * turn.axis();
    return result;
  };
  const auto cost = [&](const Poses& poses) {
    double sum = 0;
    for (const PoseGraphEdge& e : edges_) {
      const auto error =
          twist(poses[e.reference].inverse() * poses[e.moving] * e.reference_from_moving.inverse());
      sum += error.dot(e.covariance.inverse() * error);
    }
    for (const PosePrior& p : priors_) {
      const auto error = twist(p.world_from_node.inverse() * poses[p.node]);
      sum += error.dot(p.covariance.inverse() * error);
    }
    return sum;
  };
  const double least = cost(solution.world_from_node);
  for (int trial = 0; trial < 20; ++trial) {
    Poses other = solution.world_from_node;
    for (Eigen::Isometry3d& pose : other) pose = pose * disturbance(1e-3, 1e-3);
    EXPECT_GT(cost(other), least);
  }
}

TEST(PoseGraphEdgeCases, WithoutEdgesThePriorsHold) {
  const Poses poses = {motion({1, 2, 3}, {0.1, 0.2, 0.3}), motion({4, 5, 6}, {0, 0, 3})};
  const std::vector<PosePrior> priors = {{0, poses[0], covariance(0.1, 0.1)},
                                         {1, poses[1], covariance(0.1, 0.1)}};
  const PoseGraphSolution solution = solvePoseGraph(Poses(2, Eigen::Isometry3d::Identity()), {}, priors);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(solution.world_from_node[i].isApprox(poses[i], 1e-6));
  EXPECT_TRUE(solvePoseGraph({}, {}, {}).world_from_node.empty());
}

TEST(PoseGraphEdgeCases, RefusesWhatIsNotDetermined) {
  const Poses poses(3, Eigen::Isometry3d::Identity());
  const std::vector<PosePrior> first = {{0, poses[0], covariance(0.1, 0.1)}};
  const std::vector<PoseGraphEdge> chain = {{0, 1, poses[0], covariance(0.1, 0.1)}};
  EXPECT_THROW(solvePoseGraph(poses, chain, first), std::runtime_error);
}

TEST(PoseGraphEdgeCases, RefusesWrongInput) {
  const Poses poses(2, Eigen::Isometry3d::Identity());
  const PosePrior prior{0, poses[0], covariance(0.1, 0.1)};
  const PoseGraphEdge edge{0, 1, poses[0], covariance(0.1, 0.1)};
  PoseGraphEdge stray = edge, loop = edge, flat = edge;
  stray.moving = 2;
  loop.moving = 0;
  flat.covariance(0, 0) = 0;
  for (const PoseGraphEdge& wrong : {stray, loop, flat})
    EXPECT_THROW(solvePoseGraph(poses, {wrong}, {prior}), std::invalid_argument);
  EXPECT_THROW(solvePoseGraph(poses, {edge}, {{5, poses[0], covariance(0.1, 0.1)}}), std::invalid_argument);
  PoseGraphParameters parameters;
  parameters.outlier_deviation = 0;
  EXPECT_THROW(solvePoseGraph(poses, {edge}, {prior}, parameters), std::invalid_argument);
  parameters = {};
  parameters.max_iterations = 0;
  EXPECT_THROW(solvePoseGraph(poses, {edge}, {prior}, parameters), std::invalid_argument);
}

TEST_P(PoseGraph, RightEdgesAreConsistent) {
  EXPECT_EQ(consistentEdges(edges_), std::vector<bool>(edges_.size(), true));
}

/// Shifts edges by as much in the world, so that they agree with each other.
void shiftTogether(std::vector<PoseGraphEdge>& edges, const Poses& truth,
                   const std::vector<std::size_t>& which) {
  const Eigen::Translation3d shift(0.5, 0.2, 0);
  for (const std::size_t e : which) {
    const Eigen::Isometry3d& world_from_reference = truth[edges[e].reference];
    edges[e].reference_from_moving =
        world_from_reference.inverse() * shift * world_from_reference * edges[e].reference_from_moving;
  }
}

// Two of the four edges that join the second transect to the third say the same wrong thing, and contradict
// the other two, which are joined along the transects and so agree with more.
TEST_P(PoseGraph, ASetOfWrongEdgesThatAgreeGoesAsAWhole) {
  join(4, 9);
  join(5, 10);
  std::vector<std::size_t> wrong;
  for (std::size_t e = 0; e < edges_.size(); ++e)
    if (edges_[e].moving == edges_[e].reference + 4 && (edges_[e].reference == 4 || edges_[e].reference == 5))
      wrong.push_back(e);
  ASSERT_EQ(wrong.size(), 2U);
  shiftTogether(edges_, truth_, wrong);
  const std::vector<bool> kept = consistentEdges(edges_);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    EXPECT_EQ(kept[e], std::find(wrong.begin(), wrong.end(), e) == wrong.end()) << e;
}

TEST_P(PoseGraph, SingleWrongEdgesAreFoundWhereverTheyAre) {
  for (std::size_t wrong = 0; wrong < edges_.size(); ++wrong) {
    std::vector<PoseGraphEdge> edges = edges_;
    shiftTogether(edges, truth_, {wrong});
    const std::vector<bool> kept = consistentEdges(edges);
    // An edge of the rim is in one square only, and any of that square's four may be the wrong one.
    EXPECT_NE(std::count(kept.begin(), kept.end(), false), 0) << wrong;
    EXPECT_LE(std::count(kept.begin(), kept.end(), false), 2) << wrong;
  }
}

TEST(ConsistentEdges, InNoCycleStay) {
  const PoseGraphEdge edge{0, 1, Eigen::Isometry3d::Identity(), covariance(0.01, 0.01)};
  EXPECT_EQ(consistentEdges({edge}), std::vector<bool>{true});
  EXPECT_TRUE(consistentEdges({}).empty());
}

TEST_P(PoseGraph, CovariancesAreThoseOfTheErrors) {
  const PoseGraphSolution solution = solvePoseGraph(navigation_, edges_, priors_);
  const std::vector<MotionCovariance> covariances = poseCovariances(solution, edges_, priors_);
  ASSERT_EQ(covariances.size(), truth_.size());
  EXPECT_TRUE(poseCovariances(solution, {}, {}).empty());  // nothing holds the poses
  double surprise = 0;
  for (std::size_t n = 0; n < truth_.size(); ++n) {
    const Eigen::Isometry3d off = solution.world_from_node[n].inverse() * truth_[n];
    const Eigen::AngleAxisd turn(off.linear());
    Vector6d error;
    error << off.translation(), turn.angle() * turn.axis();
    surprise += error.dot(covariances[n].llt().solve(error)) / 6;
    // Better known than by navigation, worse than by one edge.
    EXPECT_LT(covariances[n](0, 0), 0.01);
    EXPECT_GT(covariances[n](0, 0), 0.002 * 0.002);
  }
  // The errors of all poses are nearly one, so that this is the mean of few.
  EXPECT_LT(surprise / static_cast<double>(truth_.size()), 3.5);
}

}  // namespace
}  // namespace pcl_fft_ground::core
