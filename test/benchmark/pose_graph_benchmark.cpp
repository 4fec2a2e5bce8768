// Time of the pose graph of a large survey: sub-maps on a square, each held to those around it by six
// alignments, some of them false. `pose_graph_benchmark [POSES [FALSE_SHARE]]`, 10,000 and 0.001 by default.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace {

using namespace pcl_fft_ground::core;

std::mt19937 randomness(1);

Eigen::Isometry3d motionOfSize(double metres, double radians) {
  std::normal_distribution<double> normal;
  const auto drawn = [&] {
    return Eigen::Vector3d(normal(randomness), normal(randomness), normal(randomness));
  };
  const Eigen::Vector3d turn = radians * drawn();
  return Eigen::Translation3d(metres * drawn()) *
         Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? turn.normalized() : Eigen::Vector3d::UnitZ());
}

MotionCovariance covarianceOf(double metres, double radians) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(metres * metres),
      Eigen::Vector3d::Constant(radians * radians);
  return covariance;
}

struct Survey {
  std::vector<Eigen::Isometry3d> truth, start;
  std::vector<PoseGraphEdge> edges;
  std::vector<PosePrior> priors;
};

Survey squareOf(std::size_t poses, double false_share) {
  constexpr double APART = 2, NAVIGATION = 0.1, HEADING = 0.03, ALIGNED = 0.002,
                   TURNED = 0.001;  // [m], [rad]
  const auto side = static_cast<long>(std::ceil(std::sqrt(static_cast<double>(poses))));
  Survey survey;
  for (std::size_t n = 0; n < poses; ++n) {
    const auto at = static_cast<long>(n);
    survey.truth.emplace_back(Eigen::Translation3d(APART * static_cast<double>(at % side),
                                                   APART * static_cast<double>(at / side), 0));
    survey.start.push_back(survey.truth.back() * motionOfSize(NAVIGATION, HEADING));
    survey.priors.push_back({n, survey.start.back(), covarianceOf(NAVIGATION, HEADING)});
  }
  const std::vector<std::pair<long, long>> beside{{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}};
  std::bernoulli_distribution is_false(false_share);
  for (std::size_t n = 0; n < poses; ++n)
    for (const auto& [i, j] : beside) {
      const long row = static_cast<long>(n) % side + i, col = static_cast<long>(n) / side + j;
      const auto other = static_cast<std::size_t>(row + col * side);
      if (row < 0 || row >= side || col < 0 || other >= poses) continue;
      const Eigen::Isometry3d motion = survey.truth[n].inverse() * survey.truth[other];
      const Eigen::Isometry3d error =
          is_false(randomness) ? motionOfSize(1, 0.1) : motionOfSize(ALIGNED, TURNED);
      survey.edges.push_back({n, other, error * motion, covarianceOf(ALIGNED, TURNED)});
    }
  return survey;
}

double rms(const std::vector<Eigen::Isometry3d>& poses, const std::vector<Eigen::Isometry3d>& truth) {
  double squares = 0;
  for (std::size_t n = 0; n < poses.size(); ++n)
    squares += (poses[n].translation() - truth[n].translation()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(poses.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t poses = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 10000;
  const double false_share = argc > 2 ? std::strtod(argv[2], nullptr) : 0.001;
  const Survey survey = squareOf(poses, false_share);
  const auto begun = std::chrono::steady_clock::now();
  const PoseGraphSolution solution = solvePoseGraph(survey.start, survey.edges, survey.priors);
  const auto solved = std::chrono::steady_clock::now();
  const std::chrono::duration<double> taken = solved - begun;
  const std::vector<bool> kept = consistentEdges(survey.edges);
  const std::chrono::duration<double> compared = std::chrono::steady_clock::now() - solved;
  std::printf("%zu poses, %zu edges: %.2f s, %s; rms from the truth %.4f m, %.4f m before\n", poses,
              survey.edges.size(), taken.count(), solution.converged ? "converged" : "not converged",
              rms(solution.world_from_node, survey.truth), rms(survey.start, survey.truth));
  std::printf("edges compared around cycles: %.2f s, %td left out\n", compared.count(),
              std::count(kept.begin(), kept.end(), false));
  return solution.converged ? 0 : 1;
}
