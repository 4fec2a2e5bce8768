#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/survey/survey.h"

namespace pcl_fft_ground::core {

/// A line of Table II: what a method made of the pairs of the chain.
struct CrispnessRow {
  std::string method;
  std::optional<double> mean;       ///< of delta Nx over the pairs that were aligned [%]
  std::optional<double> deviation;  ///< standard deviation of the same [%]
  std::size_t rose = 0;             ///< pairs with delta Nx > 0
  std::size_t not_computed = 0;     ///< delta Nx = 0
  std::size_t fell = 0;             ///< delta Nx < 0
  std::size_t unprocessed = 0;      ///< a scan without segments, or one that the method cannot work on
  std::string not_run;              ///< why the method could not work on the first such pair; mostly empty
};

/// What the paper could not measure: how right the alignments are. Over the pairs of the chain that overlap.
struct AccuracyRow {
  std::string method;
  std::size_t overlapping = 0;  ///< pairs that overlap
  std::size_t aligned = 0;      ///< of these
  double aligned_bound = 0;     ///< the share of pairs aligned is at least this, with 90 % confidence
  std::size_t wrong = 0;        ///< aligned, but off by more than 5 cm; pairs without overlap count, too
  std::optional<double> median_translation;  ///< residual of the aligned pairs [m]
  std::optional<double> high_translation;    ///< 90 % of them are below [m]
  std::optional<double> median_rotation;     ///< [degrees]
  std::optional<double> high_rotation;       ///< [degrees]
};

/// One row for each method, in the order of their first results. Pairs beside the chain do not count.
PCL_FFT_GROUND_CORE_EXPORT std::vector<CrispnessRow> crispnessTable(const std::vector<PairResult>& results);

/// The same for the accuracy; residuals only of results that have them.
PCL_FFT_GROUND_CORE_EXPORT std::vector<AccuracyRow> accuracyTable(const std::vector<PairResult>& results);

/// Lower end of a one-sided 90 % confidence interval of a share (Wilson's score interval); 0 without trials.
PCL_FFT_GROUND_CORE_EXPORT double lowerBound(std::size_t successes, std::size_t trials);

/// Value below which `share` of the values lie, by the nearest rank; none of no values.
PCL_FFT_GROUND_CORE_EXPORT std::optional<double> quantileOf(std::vector<double> values, double share);

}  // namespace pcl_fft_ground::core
