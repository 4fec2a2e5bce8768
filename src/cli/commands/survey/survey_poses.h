#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "commands/survey/survey_folder.h"
#include "commands/survey/survey_pair.h"
#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace pcl_fft_ground::cli {

/// How far navigation is trusted.
struct NavigationTrust {
  double horizontal = 0.1;  ///< standard deviation of a sub-map's place along x and y [m], > 0
  double heading = 2.0;     ///< of its heading [degrees], > 0
};

/// Poses of all sub-maps of a survey, found in different ways.
struct SurveyPoses {
  std::vector<Eigen::Isometry3d> navigation;
  std::vector<Eigen::Isometry3d> chained;  ///< one pair of the chain after the other
  std::vector<Eigen::Isometry3d> global;   ///< all pairs and the navigation as one
  std::size_t edges = 0;                   ///< aligned pairs that the global poses rest on
  std::size_t rejected_edges = 0;          ///< of these, such that count less than a quarter: false
};

/** Poses from the aligned pairs of one method.
 * \param results those of all methods; refused pairs have no say
 * \param mapping the method whose pairs are used */
SurveyPoses solveSurvey(const SurveyFolder& survey, const std::vector<PairResult>& results,
                        const std::string& mapping, const NavigationTrust& trust);

/// How far poses are from the truth, once they are laid on it as a whole.
struct PoseErrors {
  double rms_translation = 0;  ///< root mean square over the middles of the sub-maps [m]
  double max_translation = 0;  ///< [m]
  double median_rotation = 0;  ///< [degrees]
};

/// The errors of poses. \param survey with its truth
PoseErrors poseErrors(const SurveyFolder& survey, const std::vector<Eigen::Isometry3d>& poses);

nlohmann::ordered_json asJson(const PoseErrors& errors);

}  // namespace pcl_fft_ground::cli
