#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ground/robust_cells.h"
#include "ground/robust_fit.h"
#include "ground/robust_scale.h"

namespace pcl_fft_ground::core {

/// Floors of the ground's scale, which keep it from collapsing on to the hollows.
struct ScaleFloors {
  double least = 0;     ///< [m]
  double slope = 0.03;  ///< threshold as a share of the wavelength [m/m]
};

/** A surface that is fitted scale by scale to the cell points that it takes for ground.
 *
 * Up to three scales above the ground's median residual a point is ground; far below it is an outlier. The
 * scale is the spread of the current ground's residuals, so that the ground grows outwards from what is found
 * first until it meets a step. A coarse scale looks at some of the points only.
 */
class RobustSurface {
 public:
  /// \param filter order and ripple of the band limit
  RobustSurface(CellPoints points, const GridGeometry& cells, const BandLimit& filter,
                const ScaleFloors& floors, double precision);

  /// Starts from the lower envelope at this wavelength.
  void startBelowObjects(double wavelength);

  /// Fits the surface at this wavelength, objects of the last scale staying masked.
  void refine(double wavelength);

  /// Fits the surface at the present wavelength to the points that are flagged as ground.
  void refit(const std::vector<bool>& ground);

  /// Fits the surface to other points at the present wavelength, all of them ground.
  void fitTo(const CellPoints& points);

  const BilinearGrid& grid() const { return grid_; }
  const Eigen::ArrayXXd& heights() const { return fit_->surface(); }
  const CellPoints& points() const { return points_; }
  Spread spread() const { return spread_; }

 private:
  void changeScale(double wavelength);
  void takeSamples(double per_cell);
  template <typename Work>
  void forEachSample(const Work& work) const;
  void findFootings();
  void findResiduals();
  void estimateSpread(double least, double most);
  double updateWeights();
  void fit(int steps);

  CellPoints points_;
  GridGeometry cells_;
  BandLimit filter_;
  ScaleFloors floors_;
  double precision_;

  BilinearGrid grid_;
  std::optional<PenalisedFit> fit_;
  std::vector<Eigen::Vector3d> samples_;  // the points that the present scale looks at
  std::vector<Footing> footings_;
  Eigen::ArrayXf residuals_, weights_, last_weights_;  // of the samples
  std::vector<float> ground_residuals_;
  RadixSort sort_;
  Eigen::Array2Xd sums_;  // per cell of the scale's grid: of the weights, of the weighted residuals
  Eigen::ArrayXXd cell_weights_, cell_residuals_;
  Spread spread_;
};

}  // namespace pcl_fft_ground::core
