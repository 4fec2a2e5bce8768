#include "pcl_fft_ground/core/low_pass_ground.h"

namespace pcl_fft_ground::core {
namespace {

/// The elevation with its axes lengthened as asked for.
Eigen::ArrayXXd transformInput(const ElevationGrid& grid, GridLengths lengths) {
  if (lengths == GridLengths::EXACT) return grid.elevation;
  return extendedElevation(grid, smoothLength(grid.elevation.rows()), smoothLength(grid.elevation.cols()));
}

Cutoff chooseCutoff(const LowPassGround& ground, const LowPassParameters& parameters) {
  if (!parameters.cutoff_frequency)
    return selectCutoff(ground.peaks, parameters.cell_size, ground.max_object_size);
  const double f_c = *parameters.cutoff_frequency;
  return {f_c, largestObject(f_c, parameters.cell_size), std::nullopt, CutoffSource::GIVEN};
}

}  // namespace

LowPassGround estimateLowPassGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                    const LowPassParameters& parameters) {
  LowPassGround ground;
  if (points.cols() == 0) return ground;
  const Bounds bounds = boundsOf(points);
  ground.elevation = rasteriseHighest(points, gridAround(bounds, parameters.cell_size));  // Sec. IV-A
  ground.extent = (bounds.high - bounds.low).head<2>().minCoeff();
  ground.max_object_size =
      parameters.max_object_size.value_or(parameters.relative_max_object_size * ground.extent);

  ground.spectrum = forwardTransform(transformInput(ground.elevation, parameters.grid_lengths));
  ground.peaks = findSpectrumPeaks(magnitude(ground.spectrum), parameters.peaks);  // eq. (3)
  ground.cutoff = chooseCutoff(ground, parameters);                                // eq. (4)
  ground.filter = {ground.cutoff.frequency, parameters.filter_order, parameters.passband_ripple};

  const GridGeometry& cells = ground.elevation.geometry;
  const Eigen::ArrayXXd low_pass = inverseTransform(ground.filteredSpectrum());                // eq. (1), (2)
  ground.surface = {frame_from_input, cells, low_pass.topLeftCorner(cells.rows, cells.cols)};  // Sec. IV-B3
  return ground;
}

}  // namespace pcl_fft_ground::core
