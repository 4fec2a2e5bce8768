#include "pcl_fft_ground/core/ground/low_pass_ground.h"

#include <utility>

namespace pcl_fft_ground::core {
namespace {

/// The cells with their axes lengthened as asked for: the transform's input.
GridGeometry transformCells(GridGeometry cells, GridLengths lengths) {
  if (lengths == GridLengths::EXACT) return cells;
  cells.rows = smoothLength(cells.rows);
  cells.cols = smoothLength(cells.cols);
  return cells;
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
  const GridGeometry cells = gridAround(bounds, parameters.cell_size);
  ElevationGrid input =
      rasteriseHighest(points, transformCells(cells, parameters.grid_lengths));  // Sec. IV-A
  ground.spectrum = forwardTransform(input.elevation);
  ground.elevation = lowerCorner(std::move(input), cells.rows, cells.cols);
  ground.extent = (bounds.high - bounds.low).head<2>().minCoeff();
  ground.max_object_size =
      parameters.max_object_size.value_or(parameters.relative_max_object_size * ground.extent);

  ground.peaks = findSpectrumPeaks(magnitude(ground.spectrum), parameters.peaks);  // eq. (3)
  ground.cutoff = chooseCutoff(ground, parameters);                                // eq. (4)
  ground.filter = {ground.cutoff.frequency, parameters.filter_order, parameters.passband_ripple};

  const Eigen::ArrayXXd low_pass = inverseTransform(ground.filteredSpectrum());                // eq. (1), (2)
  ground.surface = {frame_from_input, cells, low_pass.topLeftCorner(cells.rows, cells.cols)};  // Sec. IV-B3
  return ground;
}

}  // namespace pcl_fft_ground::core
