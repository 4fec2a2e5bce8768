#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_fft_ground/core/export.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/tiles/tiling.h"

namespace pcl_fft_ground::core {

/** How far around a tile the ground is looked at, in largest objects (or in finest wavelengths, where these
 * are longer): an object that reaches into the tile must be seen whole, with ground around it, and what is
 * wrong at the edge of the part that is seen must have died away.
 */
constexpr double TILE_MARGIN = 2;

/// Tiles of the cells of a plan, with that margin.
PCL_FFT_GROUND_CORE_EXPORT Tiling tilingOf(const RobustPlan& plan, double tile_size);

/// The ground of a tile and around it.
struct TileGround {
  CellWindow window;    ///< of the site: the cells of `ground`
  RobustGround ground;  ///< its tolerances are not chosen; `standing` is told in cells of the site
};

/** Fits the ground of a tile; of the margin only as much is kept as its neighbours need.
 * \param level_points points in what is seen of the tile, or plannedSample() of them; where there are none,
 *        the ground has empty cells only
 * \param plan of the whole site, verdicts in its cells
 */
PCL_FFT_GROUND_CORE_EXPORT TileGround fitTile(const PointsView& level_points,
                                              const Eigen::Isometry3d& frame_from_input,
                                              const RobustPlan& plan, const RobustParameters& parameters,
                                              const Tiling& tiling, std::size_t tile);

/// What is known of the breaks of a site's land once all tiles have been looked at.
struct SiteBreaks {
  bool land_breaks = false;
  std::vector<BreakVerdict>
      verdicts;  ///< in cells of the site: of a part of a region that its tile misjudged
};

/** Judges what stands out of the ground of all tiles: a region that goes over seams is one, and judged as the
 * whole that it is.
 * \param plan of the whole site
 * \param standing of fitTile(), by which nothing was known of breaks; of all tiles
 */
PCL_FFT_GROUND_CORE_EXPORT SiteBreaks breaksOf(const RobustPlan& plan,
                                               const std::vector<StandingRegion>& standing);

/// Whether a tile must be fitted again: it had another answer than the site. \param tile fitted before
PCL_FFT_GROUND_CORE_EXPORT bool contradicts(const TileGround& tile, const SiteBreaks& breaks,
                                            const Tiling& tiling, std::size_t number);

/// The plan for that. \param plan of the whole site
PCL_FFT_GROUND_CORE_EXPORT RobustPlan withBreaks(RobustPlan plan, const SiteBreaks& breaks);

/// The tiles whose ground is blended in a tile, itself among them, ascending.
PCL_FFT_GROUND_CORE_EXPORT std::vector<std::size_t> blendedTiles(const Tiling& tiling, std::size_t tile);

/** The ground of a tile without seams: around the borders of tiles the surfaces go over into one another.
 * \param grounds of blendedTiles(), in that order; what has no points counts for nothing
 * \return the tile's own cells and two more on each side, so that neighbours interpolate alike
 */
PCL_FFT_GROUND_CORE_EXPORT TileGround blendedGround(const Tiling& tiling, std::size_t tile,
                                                    const std::vector<TileGround>& grounds);

/// What a tile tells about the whole ground.
struct TileSpread {
  double scale = 0;           ///< spread of its ground points [m]
  Eigen::Index observed = 0;  ///< its own cells that hold points
};

PCL_FFT_GROUND_CORE_EXPORT TileSpread spreadOf(const TileGround& ground, const CellWindow& core);

/// The spread of the ground of a site: the median over its observed cells [m]; 0 for none.
PCL_FFT_GROUND_CORE_EXPORT double siteSpread(std::vector<TileSpread> tiles);

}  // namespace pcl_fft_ground::core
