#include "survey_trials.h"

#include <pcl/point_types.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <ctime>

#include "pcl_fft_ground/core/survey/pairing.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace {

namespace core = pcl_fft_ground::core;
using Random = boost::random::mt19937;

double uniform(Random& random, double low, double high) {
  return boost::random::uniform_real_distribution<double>(low, high)(random);
}

core::Labels labelsOf(const core::Points& points) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    cloud->push_back({points(0, n), points(1, n), points(2, n)});
  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  filter.setMaximumObjectSize(1.0);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);
  core::Labels labels(cloud->size(), core::Label::GROUND);
  for (const pcl::index_t n : objects.indices) labels[static_cast<std::size_t>(n)] = core::Label::OBJECT;
  return labels;
}

core::Points everyTenth(const core::Points& points) {
  constexpr Eigen::Index ONE_IN = 10;
  core::Points thinned(3, points.cols() / ONE_IN);
  for (Eigen::Index n = 0; n < thinned.cols(); ++n) thinned.col(n) = points.col(ONE_IN * n);
  return thinned;
}

core::ScanSegments segmentsOf(const core::Points& points) {
  return core::describeScan(points, labelsOf(points));
}

Eigen::Isometry3d turned(double angle) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

/// Amid the two scans, in the frame of the moving one: both have their origins amid their footprints.
Eigen::Vector3d middleOf(const Eigen::Isometry3d& reference_from_moving) {
  return 0.5 * reference_from_moving.inverse().translation();
}

}  // namespace

TrialSurvey makeSurvey(const core::SurveyParameters& parameters) {
  const core::SurveySimulation simulation(parameters);
  TrialSurvey survey;
  for (std::size_t n = 0; n < simulation.size(); ++n) {
    const core::SimulatedSubmap submap = simulation.submap(n);
    survey.push_back({std::to_string(parameters.seed) + "/" + std::to_string(n),
                      segmentsOf(submap.scan.points), segmentsOf(everyTenth(submap.scan.points)),
                      submap.scan.world_from_scan, submap.world_from_navigation});
  }
  return survey;
}

std::vector<Trial> overlappingPairs(const TrialSurvey& survey, double least_overlap) {
  std::vector<core::ScanCoverage> coverages;
  std::vector<Eigen::Isometry3d> poses;
  for (const TrialScan& scan : survey) {
    coverages.push_back(scan.segments.coverage);
    poses.push_back(scan.world_from_scan);
  }
  std::vector<Trial> trials;
  for (const core::SubmapPair& pair : core::otherOverlappingPairs(coverages, poses, {}, least_overlap)) {
    const TrialScan& moving = survey[pair.moving];
    const TrialScan& reference = survey[pair.reference];
    trials.push_back({moving.name + " on " + reference.name, &moving.segments, &reference.segments,
                      reference.world_from_navigation.inverse() * moving.world_from_navigation,
                      reference.world_from_scan.inverse() * moving.world_from_scan});
  }
  return trials;
}

std::vector<Trial> misguided(std::vector<Trial> trials, const GuessError& error, unsigned seed) {
  Random random(seed);
  for (Trial& trial : trials) {
    const double direction = uniform(random, -EIGEN_PI, EIGEN_PI);
    const double turn = (uniform(random, -1, 1) < 0 ? -1 : 1) * error.turn * EIGEN_PI / 180;
    const Eigen::Translation3d shift(error.shift * std::cos(direction), error.shift * std::sin(direction), 0);
    const Eigen::Translation3d middle(trial.truth * middleOf(trial.truth));
    trial.guess = shift * middle * turned(turn) * middle.inverse() * trial.truth;
  }
  return trials;
}

std::vector<Trial> differentPlaces(const TrialSurvey& moving, const TrialSurvey& reference, unsigned seed) {
  constexpr double SHIFT = 1, TURN = 6 * EIGEN_PI / 180;
  Random random(seed);
  std::vector<Trial> trials;
  for (std::size_t n = 0; n < 2 * moving.size(); ++n) {
    const double x = uniform(random, -SHIFT, SHIFT), y = uniform(random, -SHIFT / 2, SHIFT / 2);
    const Eigen::Isometry3d guess = Eigen::Translation3d(x, y, 0) * turned(uniform(random, -TURN, TURN));
    const TrialScan& above = moving[n / 2];
    const TrialScan& below = reference[(3 * n + 1) % reference.size()];
    trials.push_back({above.name + " on " + below.name, &above.segments, &below.segments, guess, guess});
  }
  return trials;
}

bool TrialOutcome::wrong() const {
  constexpr double WRONG_BY = 0.05, WRONG_TURN = 2;
  return alignment.accepted && (error > WRONG_BY || turn > WRONG_TURN);
}

TrialOutcome run(const Trial& trial, const core::AlignmentParameters& parameters) {
  TrialOutcome outcome;
  const std::clock_t begun = std::clock();
  outcome.alignment = core::alignScans(*trial.moving, *trial.reference, trial.guess, parameters);
  outcome.seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  const Eigen::Isometry3d& found = outcome.alignment.reference_from_moving;
  const Eigen::Vector3d middle = middleOf(trial.truth);
  outcome.error = (found * middle - trial.truth * middle).norm();
  outcome.turn =
      Eigen::AngleAxisd(trial.truth.linear().transpose() * found.linear()).angle() * 180 / EIGEN_PI;
  return outcome;
}

void TrialResults::add(const TrialOutcome& outcome) {
  ++trials;
  seconds.push_back(outcome.seconds);
  if (!outcome.alignment.accepted) return;
  ++accepted;
  if (outcome.alignment.method == core::AlignmentMethod::DENSE) ++dense;
  if (outcome.wrong()) ++wrong;
  errors.push_back(outcome.error);
}
