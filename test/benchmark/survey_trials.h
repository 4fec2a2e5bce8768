#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/align/segment_alignment.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"

/// A sub-map of a simulated survey as alignment sees it, with its true pose.
struct TrialScan {
  std::string name;                             ///< seed and number
  pcl_fft_ground::core::ScanSegments segments;  ///< of all points
  pcl_fft_ground::core::ScanSegments thinned;   ///< of every tenth point
  Eigen::Isometry3d world_from_scan = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d world_from_navigation = Eigen::Isometry3d::Identity();
};

using TrialSurvey = std::vector<TrialScan>;

/// Simulates a survey and segments its sub-maps by the robust ground.
TrialSurvey makeSurvey(const pcl_fft_ground::core::SurveyParameters& parameters);

/// How far off the initial guess of a trial is.
struct GuessError {
  double shift = 0;  ///< horizontally, in a random direction [m]
  double turn = 0;   ///< about the vertical, either way [degrees]
};

/// Two scans to be aligned.
struct Trial {
  std::string name;  ///< of both scans
  const pcl_fft_ground::core::ScanSegments* moving;
  const pcl_fft_ground::core::ScanSegments* reference;
  Eigen::Isometry3d guess;  ///< reference_from_moving
  Eigen::Isometry3d truth;  ///< reference_from_moving
};

/// All pairs of a survey of which `least_overlap` of the smaller one is seen by both, guessed by navigation.
std::vector<Trial> overlappingPairs(const TrialSurvey& survey, double least_overlap);

/// The same trials with guesses that are off by as much about the middle of the overlap. Equal seeds give
/// equal guesses.
std::vector<Trial> misguided(std::vector<Trial> trials, const GuessError& error, unsigned seed);

/// Each sub-map of a survey laid over two of another one, up to a metre and 6 degrees from lying just on it.
std::vector<Trial> differentPlaces(const TrialSurvey& moving, const TrialSurvey& reference, unsigned seed);

/// What came of a trial.
struct TrialOutcome {
  pcl_fft_ground::core::Alignment alignment;
  double seconds = 0;  ///< CPU time
  double error = 0;    ///< amid the overlap [m]
  double turn = 0;     ///< off the true transform [degrees]

  bool wrong() const;  ///< accepted, and off by more than 5 cm or 2 degrees
};

/// Aligns one pair.
TrialOutcome run(const Trial& trial, const pcl_fft_ground::core::AlignmentParameters& parameters);

/// What came of several trials.
struct TrialResults {
  std::size_t trials = 0;
  std::size_t accepted = 0;
  std::size_t dense = 0;        ///< of the accepted, by the dense fallback
  std::size_t wrong = 0;        ///< of the accepted
  std::vector<double> errors;   ///< of the accepted [m]
  std::vector<double> seconds;  ///< CPU time of each alignment

  void add(const TrialOutcome& outcome);
};
