#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/grid/elevation_grid.h"
#include "pcl_fft_ground/core/ground/ground_surface.h"
#include "pcl_fft_ground/core/ground/labels.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/points.h"

namespace pcl_fft_ground::core {

/// Which height stands for a cell until the ground points in it are known.
enum class CellStatistic {
  LOWEST,  ///< the lowest point; of four points or more the second lowest, as one may be an outlier
  MEAN,    ///< the mean
};

/// Settings of estimateRobustGround(). What is not set is chosen from the data.
struct RobustParameters {
  double relative_max_object_size = 0.5;    ///< m_u: largest object as a share of the scan's extent, (0, 1]
  std::optional<double> max_object_size;    ///< largest object [m], > 0; takes the place of m_u
  std::optional<double> cell_size;          ///< side of an elevation cell [m], > 0
  std::optional<double> height_tolerance;   ///< height above ground from which a point is an object [m], >= 0
  std::optional<double> finest_wavelength;  ///< shortest wavelength of the ground [m], > 0
  std::optional<double> max_slope;          ///< steepest ground [m/m], > 0: for land with breaks and terraces
  std::optional<CellStatistic> statistic;   ///< height of a cell
  unsigned filter_order = 2;                ///< n of eq. (1), >= 1
  double passband_ripple = 3.0;             ///< A of eq. (1) [dB], > 0
};

/// A value that was chosen from the data.
struct RobustChoice {
  std::string parameter;  ///< name as in RobustParameters
  double value = 0;       ///< in the parameter's unit
  std::string reason;     ///< a short sentence
};

/// How steep the land may be that regions of cells standing out of the ground are gathered from.
enum class BreakSlope : unsigned char {
  PROOF,   ///< of which some prove that the land breaks
  GENTLE,  ///< of which the large ones are no objects
  BROKEN,  ///< of which some are land, where the land is known to break
};

/// Whether the region that holds a cell is land, as it is known of the whole of it.
struct BreakVerdict {
  BreakSlope slope = BreakSlope::PROOF;
  Eigen::Index row = 0, col = 0;  ///< of the cell
  bool is_land = false;
};

/// A region of cells that stand out of the ground, or the part of it in a tile, as it is judged: whether it
/// is an object or land above a break. Sums of parts are those of the whole region.
struct StandingRegion {
  BreakSlope slope = BreakSlope::PROOF;
  bool is_land = false;                                                 ///< by what is seen of it here
  Eigen::Index low_row = 0, low_col = 0, high_row = -1, high_col = -1;  ///< of its cells
  double area = 0;                                                      ///< [cells]
  double border = 0;                                                    ///< of these at the scan's border
  double pairs = 0;         ///< of a cell and an observed one beside it that is not of the region
  double ground_pairs = 0;  ///< of these with ground
  double gentle_pairs = 0;  ///< of these that climb gently
  double higher_pairs = 0;  ///< whose other cell, no ground, stands out of the region
  bool broad = false;       ///< holds a square of a fifth of the largest object
  std::vector<std::pair<Eigen::Index, Eigen::Index>>
      seam;  ///< rows and columns of its cells at the tile's edge
};

/// How many points lie in each of equal steps above the ground, and below it, up to the depth tolerance.
struct ClearanceCounts {
  static constexpr std::size_t STEPS = 512;
  std::array<std::uint64_t, STEPS> above{}, below{};

  PCL_FFT_GROUND_CORE_EXPORT void add(const ClearanceCounts& part);
};

/// The share of the ground among the points of each of these steps above it, in [0, 1].
using GroundShares = std::array<float, ClearanceCounts::STEPS>;

/// The ground of a scan, how sure it is, and what led to it.
struct RobustGround {
  ElevationGrid elevation;     ///< height of each cell by the statistic
  Bounds bounds;               ///< of the points in the level frame
  double spacing = 0;          ///< distance of neighbouring points [m], of a whole scan
  double extent = 0;           ///< smaller horizontal extent of the points [m]
  double max_object_size = 0;  ///< m_u extent, or the size given [m]
  GroundSurface surface;       ///< the ground; supported within the finest wavelength of observed ground
  Eigen::ArrayXXf lowest;      ///< height of each cell's lowest point above the surface [m], 0 for none
  Eigen::ArrayXXf steps;       ///< height of the ground's step up from each cell to the next [m], 0 for none
  double scale = 0;            ///< spread of the ground points around the surface [m]
  double tolerance = 0;        ///< an object is higher above the surface than this [m]
  double most_tolerance = 0;   ///< or than its cell's lowest point by the tolerance, up to this [m]
  double slope_tolerance = 0;  ///< plus this times the local slope [m]
  double depth_tolerance = 0;  ///< a point deeper below the surface than this is an object [m]
  GroundShares shares{};       ///< of the points above the surface
  double finest_wavelength = 0;       ///< of the surface [m]
  std::vector<double> wavelengths;    ///< all scales, coarse to fine [m]
  std::vector<RobustChoice> choices;  ///< of the values that were not set
  bool land_breaks = false;  ///< whether it is known that the land breaks: proven here or by the plan
  std::vector<StandingRegion> standing;  ///< in the plan's own cells, where it has some: evidence of breaks
};

/** The ground of a level scan as a band-limited surface fitted to the ground cells only, coarse to fine:
 *
 *     minimise  sum_i w_i (y_i - s_i)^2 + sum_k P_k |s^_k|^2,   P_k = eps^2 (d / d_c)^(2n),
 *
 * where s^ is the cosine transform of the surface s, w is 0 for an empty cell, near 0 on an object and 1 on
 * the ground. With w = 1 everywhere this is the Butterworth power response of eq. (1). The weights follow
 * from the residuals of the current surface; it starts from the lower envelope at the largest object's size
 * or, with a maximum slope, from the cells that a growing morphological opening leaves. Ground above a break
 * of the land (a quay wall, a terrace) is too large for an object and taken in; the surface bends there.
 *
 * \param level_points points in the level frame
 * \param frame_from_input the transform that brought them there, kept in the surface
 * \return a default value, with a grid of no cells, for no points
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 * \note The result does not depend on the order of the points.
 */
PCL_FFT_GROUND_CORE_EXPORT RobustGround estimateRobustGround(const PointsView& level_points,
                                                             const Eigen::Isometry3d& frame_from_input,
                                                             const RobustParameters& parameters);

/// A block of cells of a grid.
struct CellBlock {
  Eigen::Index row = 0, col = 0, rows = 0, cols = 0;
};

/// What must be the same wherever the ground of a scan is fitted, in one piece or tile by tile: all values
/// given or chosen from the whole scan.
struct RobustPlan {
  Bounds bounds;               ///< of all points, in the level frame
  Eigen::Index points = 0;     ///< number of all points
  double extent = 0;           ///< smaller horizontal extent of the points [m]
  double max_object_size = 0;  ///< [m]
  GridGeometry cells;  ///< the elevation cells: of the scan or, for a tile, those of them that it fits
  CellStatistic statistic = CellStatistic::LOWEST;
  double finest_wavelength = 0;        ///< [m]
  double slope = 0;                    ///< of the scale's floor: threshold as a share of the wavelength [m/m]
  Eigen::Index sample = 0;             ///< about as many points of the whole scan are looked at
  std::vector<RobustChoice> choices;   ///< of the values that were not set
  std::optional<bool> land_breaks;     ///< whether the land breaks, where that is known from the whole scan
  std::optional<CellBlock> own;        ///< of a tile: the cells that are no other tile's
  std::vector<BreakVerdict> verdicts;  ///< of regions that are not seen whole, in the cells of the plan
};

/** Chooses what is not set from the bounds and the number of the points of a whole scan.
 * \throws std::length_error if the grid would have more than MAX_CELLS cells
 */
PCL_FFT_GROUND_CORE_EXPORT RobustPlan planRobustGround(const RobustParameters& parameters,
                                                       const Bounds& bounds, Eigen::Index points);

/** estimateRobustGround() by a plan, but for the tolerances, which hang on the ground of the whole scan.
 * \param level_points at least one point; all points of the scan in the plan's cells, or no fewer than
 *        plannedSample() of them
 */
PCL_FFT_GROUND_CORE_EXPORT RobustGround fitRobustGround(const PointsView& level_points,
                                                        const Eigen::Isometry3d& frame_from_input,
                                                        const RobustPlan& plan,
                                                        const RobustParameters& parameters);

/// Those points of a part of the scan that a fit by the plan looks at, chosen by their coordinates.
PCL_FFT_GROUND_CORE_EXPORT Points plannedSample(const PointsView& level_points, const RobustPlan& plan);

/** Chooses the tolerances by the spread of the ground, the size of objects and the spacing of the points.
 * \param ground its scale and largest object are those of the whole scan
 * \param observed number of the scan's cells that hold points
 */
PCL_FFT_GROUND_CORE_EXPORT void chooseTolerances(const RobustParameters& parameters, const RobustPlan& plan,
                                                 Eigen::Index observed, RobustGround& ground);

/// \param level_points of which to judge
/// \param ground tolerances chosen, all else known
PCL_FFT_GROUND_CORE_EXPORT ClearanceCounts clearancesOf(const PointsView& level_points,
                                                        const RobustGround& ground);

/** Raises the tolerance where the points say so, up to the greatest one.
 *
 * Ground is as likely to lie above its surface as below it. Hence the points below a depth d are as many as
 * the ground that a tolerance d calls objects, and the points above, up to d, less those below, are objects
 * that it calls ground. The least sum is taken, the ground's share counted twice.
 *
 * \param counts of the whole scan
 */
PCL_FFT_GROUND_CORE_EXPORT void widenTolerance(const RobustParameters& parameters,
                                               const ClearanceCounts& counts, RobustGround& ground);

/** How likely points above the ground are of it.
 *
 * Ground is as likely to lie above the middle of the ground's points as below it: of the points in a step
 * above, at least as many are ground as lie in the same step below. Objects rise from the ground and are
 * about as many in each step near their feet: what is more than in the steps beyond the ground is ground,
 * too. The shares fall with the height; where the counts do not, neighbouring steps have one share.
 *
 * \param counts of the whole scan
 * \param ground its scale and depth tolerance are known
 */
PCL_FFT_GROUND_CORE_EXPORT GroundShares groundShares(const ClearanceCounts& counts,
                                                     const RobustGround& ground);

/// Labels of points, those below the ground counted apart.
struct RobustLabels {
  Labels labels;
  std::size_t below = 0;  ///< objects that are deeper than the depth tolerance below the ground: noise
};

/** Separates ground from objects by the tolerances of the ground.
 * \param level_points points in the level frame; all ground if the ground has no cells
 */
PCL_FFT_GROUND_CORE_EXPORT RobustLabels labelRobust(const PointsView& level_points,
                                                    const RobustGround& ground);

/** How likely each point is of the ground, in [0, 1]: by its height above the surface (groundShares()); 1
 * down to the depth tolerance below it, 0 deeper.
 * \param level_points points in the level frame
 * \param ground its shares are known; without cells all points are ground
 */
PCL_FFT_GROUND_CORE_EXPORT std::vector<float> groundProbability(const PointsView& level_points,
                                                                const RobustGround& ground);

}  // namespace pcl_fft_ground::core
