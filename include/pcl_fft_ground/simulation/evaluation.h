#pragma once

#include <cstddef>
#include <vector>

#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/simulation/export.h"

namespace pcl_fft_ground::core {

/// Counts of a two-class comparison (Sec. V-C); an object is positive.
struct Confusion {
  std::size_t true_positives = 0;   ///< objects called objects
  std::size_t false_positives = 0;  ///< ground called object
  std::size_t true_negatives = 0;   ///< ground called ground
  std::size_t false_negatives = 0;  ///< objects called ground

  /// Share of the objects that were found; NaN without objects.
  PCL_FFT_GROUND_SIMULATION_EXPORT double truePositiveRate() const;
  /// Share of the ground that was found; NaN without ground.
  PCL_FFT_GROUND_SIMULATION_EXPORT double trueNegativeRate() const;
  /// Share of the points called objects that are some; NaN if none was called one.
  PCL_FFT_GROUND_SIMULATION_EXPORT double precision() const;
  /// Intersection over union of the objects; NaN if there is none and none was called one.
  PCL_FFT_GROUND_SIMULATION_EXPORT double intersectionOverUnion() const;
  /// Share of wrong labels; NaN without points.
  PCL_FFT_GROUND_SIMULATION_EXPORT double totalError() const;
  /// Cohen's kappa: agreement beyond chance; NaN where chance alone explains everything.
  PCL_FFT_GROUND_SIMULATION_EXPORT double kappa() const;
  /// Harmonic mean of precision and true positive rate; NaN if there is no object and none was called one.
  PCL_FFT_GROUND_SIMULATION_EXPORT double f1() const;
};

/** Compares labels with the truth.
 * \param truth 0 ground, 1 object; every other value is not scored
 * \param labels of the same points; a point labelled NEITHER is not scored either
 * \throws std::invalid_argument if the two differ in length
 */
PCL_FFT_GROUND_SIMULATION_EXPORT Confusion compare(const std::vector<int>& truth, const Labels& labels);

}  // namespace pcl_fft_ground::core
