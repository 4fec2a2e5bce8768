#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "methods/segmentation.h"
#include "tiles/site.h"
#include "tiles/tile_store.h"

/// The work on each tile, a file of results for each step. A tile whose file is there is left alone.
namespace pcl_fft_ground::cli {

/// What the tiles tell together about the ground.
struct SiteGround {
  double spread = 0;              ///< of the ground points [m]
  std::uint64_t observed = 0;     ///< cells with points
  core::RobustGround tolerances;  ///< only the tolerances, and the sizes that they were chosen by, are set
};

/// Fits the ground of every tile.
void fitGrounds(const Site& site, const SiteRequest& request, const TileStore& store, const Advance& advance);

/// What the fitted tiles tell together.
SiteGround groundOfSite(const Site& site, const SiteRequest& request, const TileStore& store);

/// The ground of a tile with its neighbours' blended in, and the tolerances of the site.
core::TileGround groundOf(const Site& site, const SiteGround& ground, const TileStore& store,
                          std::size_t tile);

/// Tells ground from objects in every tile.
void labelTiles(const Site& site, const SiteGround& ground, const TileStore& store, const Advance& advance);

/// The labels of a tile's points, in their order in the file.
struct TileLabels {
  std::vector<core::Label> labels;
  std::vector<float> heights;        ///< above the ground [m]
  std::vector<float> probabilities;  ///< of being ground
  std::uint64_t below = 0;           ///< objects that lie below the ground
  std::uint64_t objects = 0;
};
TileLabels readLabels(const TileStore& store, std::size_t tile);

/// The objects of a tile.
struct TileObjects {
  core::Points points;  ///< as the file has them, relative to the origin
  std::vector<float> heights;
};
TileObjects readObjects(const TileStore& store, std::size_t tile);

/// Clusters the objects of every tile into segments, together with those around it.
void clusterTiles(const Site& site, const ClusterParameters& parameters, const TileStore& store,
                  const Advance& advance);

/// The segments of all tiles.
struct SiteSegments {
  std::vector<std::uint32_t> first;   ///< of each tile: how many segments the tiles before it have
  std::vector<std::int32_t> numbers;  ///< of each segment of a tile, by falling size over the site; 0 none
  std::vector<std::uint64_t> sizes;   ///< points of each number; [0] is 0

  std::size_t count() const { return sizes.size() - 1; }
};

/// Joins the segments of the tiles and numbers them.
SiteSegments joinSegments(const Site& site, const ClusterParameters& parameters, const TileStore& store);

/// The number of each object point of a tile, in their order.
std::vector<std::int32_t> numbersOf(const SiteSegments& segments, const TileStore& store, std::size_t tile);

}  // namespace pcl_fft_ground::cli
