#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "commands/evaluate/evaluation_table.h"
#include "io/cloud_file.h"
#include "methods/segmenter.h"
#include "pcl_fft_ground/core/ground/labels.h"

namespace pcl_fft_ground::cli {

/// A cloud and what is known of its truth.
struct LabelledCloud {
  std::string path;
  Cloud cloud;
  /// Points of the true ground surface: at the x and y of every point where the cloud has a floating-point
  /// field `ground` with the true height, else the points labelled ground, which are noisy [m].
  std::vector<Eigen::Vector3d> true_ground;
};

/// Reads a cloud that has labels.
/// \throws WorkError naming the file if it cannot be read, has no labels, such of unknown meaning, or none
/// that
///         is ground or object, or no finite point
LabelledCloud readLabelledCloud(const std::string& path, const ReadOptions& options = {});

/// What a method made of a cloud.
struct Evaluation {
  EvaluationRow row;
  core::Labels labels;  ///< per point; empty if the method failed
};

/// Runs a method on a cloud and compares its labels and its ground surface with the truth.
Evaluation evaluateMethod(const LabelledCloud& cloud, Segmenter& segmenter);

}  // namespace pcl_fft_ground::cli
