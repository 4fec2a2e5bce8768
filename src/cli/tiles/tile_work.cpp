#include "tiles/tile_work.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

#include "errors.h"
#include "pcl_fft_ground/core/tiles/tile_ground.h"
#include "pcl_fft_ground/core/tiles/tile_segments.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr const char* GROUND = "ground";
constexpr const char* AGAIN = "again";
constexpr const char* LABELS = "labels";
constexpr const char* OBJECTS = "objects";
constexpr const char* SEGMENTS = "segments";

/// Does the work on every tile that has no result yet.
template <typename Work>
void eachTile(const Site& site, const TileStore& store, const char* kind, const Advance& advance,
              const Work& work) {
  const std::size_t tiles = site.tiling.size();
  for (std::size_t t = 0; t < tiles; ++t) {
    if (!store.has(t, kind)) store.write(store.path(t, kind), work(t));
    advance(static_cast<double>(t + 1) / static_cast<double>(tiles));
  }
}

core::TileGround readGround(const TileStore& store, std::size_t tile) {
  ByteReader reader = store.read(store.path(tile, GROUND));
  return takeGround(reader);
}

void putPoints(const core::Points& points, ByteWriter& writer) {
  writer.put(static_cast<std::uint64_t>(points.cols()));
  writer.putAll(points.data(), static_cast<std::size_t>(points.size()));
}

core::Points takePoints(ByteReader& reader) {
  core::Points points(3, static_cast<Eigen::Index>(reader.take<std::uint64_t>()));
  reader.takeAll(points.data(), static_cast<std::size_t>(points.size()));
  return points;
}

/// The object points that are seen of a tile, tile by tile.
struct SeenObjects {
  core::Points points;                             ///< as the file has them
  std::vector<std::size_t> tiles;                  ///< ascending
  std::vector<std::vector<std::uint32_t>> places;  ///< of each of these tiles: which of its objects are seen
  std::vector<std::vector<bool>> near;             ///< and which of them lie near the seam
};

SeenObjects objectsSeen(const Site& site, const TileStore& store, std::size_t tile) {
  const core::Tiling& tiling = site.tiling;
  const core::CellWindow seen = tiling.seen(tile);
  const core::CellWindow at_seam = tiling.grown(tiling.core(tile), tiling.margin() / 2);
  SeenObjects result;
  result.tiles = tiling.tilesIn(seen);
  std::vector<float> coordinates;
  for (const std::size_t other : result.tiles) {
    const core::Points points = readObjects(store, other).points;
    const core::Points level = core::transformed(points, site.frame_from_input);
    std::vector<std::uint32_t>& places = result.places.emplace_back();
    std::vector<bool>& near = result.near.emplace_back();
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const auto [i, j] = tiling.cellAt(level(0, n), level(1, n));
      if (!seen.contains(i, j)) continue;
      places.push_back(static_cast<std::uint32_t>(n));
      near.push_back(at_seam.contains(i, j));
      coordinates.insert(coordinates.end(), points.data() + 3 * n, points.data() + 3 * n + 3);
    }
  }
  result.points =
      Eigen::Map<core::Points>(coordinates.data(), 3, static_cast<Eigen::Index>(coordinates.size() / 3));
  return result;
}

/// The number of the segment of each point, from 0.
std::vector<std::uint32_t> clustersOf(const core::Points& points, const Site& site,
                                      ClusterParameters parameters, std::uint32_t& count) {
  parameters.min_cluster_size = 1;  // the sizes are those of the site's segments
  parameters.max_cluster_size = ClusterParameters().max_cluster_size;
  Cloud cloud;
  cloud.points = pcl::make_shared<pcl::PointCloud<Point>>();
  cloud.points->reserve(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    cloud.points->emplace_back(points(0, n), points(1, n), points(2, n));
  Segmentation segmentation;
  segmentation.surface.frame_from_input = site.frame_from_input;
  segmentation.objects.indices.resize(cloud.points->size());
  std::iota(segmentation.objects.indices.begin(), segmentation.objects.indices.end(), 0);
  if (!cloud.points->empty()) clusterObjects(cloud, parameters, segmentation);
  count = static_cast<std::uint32_t>(segmentation.clusters.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(segmentation.segments.size());
  for (const std::int32_t number : segmentation.segments)
    numbers.push_back(static_cast<std::uint32_t>(number - 1));
  return numbers;
}

ByteWriter clusterTile(const Site& site, const ClusterParameters& parameters, const TileStore& store,
                       std::size_t tile) {
  const SeenObjects seen = objectsSeen(site, store, tile);
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> numbers = clustersOf(seen.points, site, parameters, count);
  ByteWriter writer;
  writer.put(count);
  std::size_t begin = 0;
  std::vector<std::uint32_t> own;
  ByteWriter seams;
  std::uint32_t neighbours = 0;
  for (std::size_t k = 0; k < seen.tiles.size(); ++k) {
    const std::size_t size = seen.places[k].size();
    const std::uint32_t* const of_tile = numbers.data() + begin;
    begin += size;
    if (seen.tiles[k] == tile) {
      own.assign(of_tile, of_tile + size);
      continue;
    }
    std::vector<std::uint32_t> places, near;
    for (std::size_t n = 0; n < size; ++n) {
      if (!seen.near[k][n]) continue;
      places.push_back(seen.places[k][n]);
      near.push_back(of_tile[n]);
    }
    seams.put(static_cast<std::uint64_t>(seen.tiles[k]));
    seams.putAll(places);
    seams.putAll(near);
    ++neighbours;
  }
  writer.putAll(own);
  writer.put(neighbours);
  writer.putAll(seams.bytes().data(), seams.bytes().size());
  return writer;
}

/// What a neighbour's object points near the seam are by the segments of a tile.
struct Seam {
  std::size_t neighbour = 0;
  std::vector<std::uint32_t> places, segments;
};

struct ClusteredTile {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> own;  ///< segment of each of the tile's own object points
  std::vector<Seam> seams;
};

ClusteredTile readClusters(const TileStore& store, std::size_t tile) {
  ByteReader reader = store.read(store.path(tile, SEGMENTS));
  ClusteredTile result;
  result.count = reader.take<std::uint32_t>();
  result.own = reader.takeAll<std::uint32_t>();
  result.seams.resize(reader.take<std::uint32_t>());
  for (Seam& seam : result.seams) {
    seam.neighbour = static_cast<std::size_t>(reader.take<std::uint64_t>());
    seam.places = reader.takeAll<std::uint32_t>();
    seam.segments = reader.takeAll<std::uint32_t>();
  }
  return result;
}

/// The points near the seam of two tiles that `seeing` has seen in `seen`.
template <typename Add>
void eachSeamPoint(const ClusteredTile& seeing, const ClusteredTile& seen, std::size_t number_of_seen,
                   const Add& add) {
  for (const Seam& seam : seeing.seams)
    if (seam.neighbour == number_of_seen)
      for (std::size_t n = 0; n < seam.places.size(); ++n) add(seam.segments[n], seen.own[seam.places[n]]);
}

/// The breaks of the site's land and the tiles that they contradict: asked once, as what is fitted again
/// tells no more about it.
struct LandOfSite {
  core::SiteBreaks breaks;
  std::vector<std::uint64_t> contradicted;
};

LandOfSite landOfSite(const Site& site, const TileStore& store) {
  const std::string file = store.path("land");
  LandOfSite land;
  if (std::filesystem::exists(file)) {
    ByteReader reader = store.read(file);
    land.breaks.land_breaks = reader.take<bool>();
    land.breaks.verdicts = reader.takeAll<core::BreakVerdict>();
    land.contradicted = reader.takeAll<std::uint64_t>();
    return land;
  }
  std::vector<core::StandingRegion> standing;
  for (std::size_t t = 0; t < site.tiling.size(); ++t) {
    core::RobustGround ground = readGround(store, t).ground;
    std::move(ground.standing.begin(), ground.standing.end(), std::back_inserter(standing));
  }
  land.breaks = core::breaksOf(site.plan, standing);
  for (std::size_t t = 0; t < site.tiling.size(); ++t)
    if (core::contradicts(readGround(store, t), land.breaks, site.tiling, t)) land.contradicted.push_back(t);
  ByteWriter writer;
  writer.put(land.breaks.land_breaks);
  writer.putAll(land.breaks.verdicts);
  writer.putAll(land.contradicted);
  store.write(file, writer);
  return land;
}

/// Of those points of a tile that its fit looked at.
core::ClearanceCounts clearancesOf(const Site& site, const SiteGround& ground, const TileStore& store,
                                   std::size_t tile) {
  core::Points points = store.readPoints(tile, "sample", site.samples_of_tile[tile]);
  const core::CellWindow own = site.tiling.core(tile);
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const auto [i, j] = site.tiling.cellAt(points(0, n), points(1, n));
    if (own.contains(i, j)) points.col(count++) = points.col(n);
  }
  return core::clearancesOf(points.leftCols(count), groundOf(site, ground, store, tile).ground);
}

}  // namespace

void fitGrounds(const Site& site, const SiteRequest& request, const TileStore& store,
                const Advance& advance) {
  core::RobustPlan plan = site.plan;
  const auto fit = [&](std::size_t t) {
    const core::Points points = store.readPoints(t, "sample", site.samples_of_tile[t]);
    ByteWriter writer;
    putGround(core::fitTile(points, site.frame_from_input, plan, request.robust, site.tiling, t), writer);
    return writer;
  };
  eachTile(site, store, GROUND, advance, fit);
  if (request.robust.max_slope) return;  // taken to break everywhere
  // What breaks is one question for the whole site: tiles that had another answer are fitted again, once.
  const LandOfSite land = landOfSite(site, store);
  plan = core::withBreaks(plan, land.breaks);
  for (const std::uint64_t t : land.contradicted) {
    const std::size_t tile = static_cast<std::size_t>(t);
    if (store.has(tile, AGAIN)) continue;
    store.write(store.path(tile, GROUND), fit(tile));
    store.write(store.path(tile, AGAIN), ByteWriter());
  }
}

SiteGround groundOfSite(const Site& site, const SiteRequest& request, const TileStore& store) {
  std::vector<core::TileSpread> spreads;
  SiteGround result;
  for (std::size_t t = 0; t < site.tiling.size(); ++t) {
    const core::TileGround ground = readGround(store, t);
    spreads.push_back(core::spreadOf(ground, site.tiling.core(t)));
    result.observed += static_cast<std::uint64_t>(spreads.back().observed);
    if (result.tolerances.wavelengths.empty()) result.tolerances.wavelengths = ground.ground.wavelengths;
  }
  result.spread = result.tolerances.scale = core::siteSpread(spreads);
  result.tolerances.extent = site.plan.extent;
  result.tolerances.max_object_size = site.plan.max_object_size;
  result.tolerances.finest_wavelength = site.plan.finest_wavelength;
  result.tolerances.choices = site.plan.choices;
  core::chooseTolerances(request.robust, site.plan, static_cast<Eigen::Index>(result.observed),
                         result.tolerances);
  core::ClearanceCounts counts;
  for (std::size_t t = 0; t < site.tiling.size(); ++t) counts.add(clearancesOf(site, result, store, t));
  core::widenTolerance(request.robust, counts, result.tolerances);
  result.tolerances.shares = core::groundShares(counts, result.tolerances);
  return result;
}

core::TileGround groundOf(const Site& site, const SiteGround& ground, const TileStore& store,
                          std::size_t tile) {
  std::vector<core::TileGround> grounds;
  for (const std::size_t other : core::blendedTiles(site.tiling, tile))
    grounds.push_back(readGround(store, other));
  core::TileGround result = core::blendedGround(site.tiling, tile, grounds);
  result.ground.surface.frame_from_input = site.frame_from_input;
  result.ground.tolerance = ground.tolerances.tolerance;
  result.ground.most_tolerance = ground.tolerances.most_tolerance;
  result.ground.slope_tolerance = ground.tolerances.slope_tolerance;
  result.ground.depth_tolerance = ground.tolerances.depth_tolerance;
  result.ground.shares = ground.tolerances.shares;
  return result;
}

void labelTiles(const Site& site, const SiteGround& ground, const TileStore& store, const Advance& advance) {
  eachTile(site, store, LABELS, advance, [&](std::size_t t) {
    const core::TileGround tile = groundOf(site, ground, store, t);
    const core::Points points = store.readPoints(t, "points", site.points_of_tile[t]);
    const core::Points level = core::transformed(points, site.frame_from_input);
    const core::RobustLabels labelled = core::labelRobust(level, tile.ground);
    std::vector<float> heights;
    heights.reserve(labelled.labels.size());
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      heights.push_back(static_cast<float>(tile.ground.surface.heightAbove(points.col(n).cast<double>())));
    core::Points objects(3, points.cols());
    std::vector<float> object_heights;
    for (std::size_t n = 0; n < labelled.labels.size(); ++n) {
      if (labelled.labels[n] != core::Label::OBJECT) continue;
      objects.col(static_cast<Eigen::Index>(object_heights.size())) =
          points.col(static_cast<Eigen::Index>(n));
      object_heights.push_back(heights[n]);
    }
    ByteWriter object_writer;
    putPoints(objects.leftCols(static_cast<Eigen::Index>(object_heights.size())), object_writer);
    object_writer.putAll(object_heights);
    store.write(store.path(t, OBJECTS), object_writer);
    ByteWriter writer;
    writer.put(static_cast<std::uint64_t>(labelled.below));
    writer.put(static_cast<std::uint64_t>(object_heights.size()));
    writer.putAll(labelled.labels);
    writer.putAll(heights);
    writer.putAll(core::groundProbability(level, tile.ground));
    return writer;
  });
}

TileLabels readLabels(const TileStore& store, std::size_t tile) {
  ByteReader reader = store.read(store.path(tile, LABELS));
  TileLabels result;
  result.below = reader.take<std::uint64_t>();
  result.objects = reader.take<std::uint64_t>();
  result.labels = reader.takeAll<core::Label>();
  result.heights = reader.takeAll<float>();
  result.probabilities = reader.takeAll<float>();
  return result;
}

TileObjects readObjects(const TileStore& store, std::size_t tile) {
  ByteReader reader = store.read(store.path(tile, OBJECTS));
  TileObjects result;
  result.points = takePoints(reader);
  result.heights = reader.takeAll<float>();
  return result;
}

void clusterTiles(const Site& site, const ClusterParameters& parameters, const TileStore& store,
                  const Advance& advance) {
  eachTile(site, store, SEGMENTS, advance,
           [&](std::size_t t) { return clusterTile(site, parameters, store, t); });
}

SiteSegments joinSegments(const Site& site, const ClusterParameters& parameters, const TileStore& store) {
  SiteSegments result;
  std::vector<std::uint64_t> points;
  for (std::size_t t = 0; t < site.tiling.size(); ++t) {
    const ClusteredTile tile = readClusters(store, t);
    result.first.push_back(static_cast<std::uint32_t>(points.size()));
    points.resize(points.size() + tile.count, 0);
    for (const std::uint32_t segment : tile.own) ++points[result.first.back() + segment];
  }
  core::TileSegments segments(points);
  const core::SeamRule rule =
      parameters.clusters == Clusters::CONTACT ? core::SeamRule::ANY : core::SeamRule::MOST;
  for (std::size_t t = 0; t < site.tiling.size(); ++t) {
    const ClusteredTile tile = readClusters(store, t);
    for (const Seam& seam : tile.seams) {
      if (seam.neighbour < t) continue;
      const ClusteredTile other = readClusters(store, seam.neighbour);
      const std::uint32_t first = result.first[t], first_of_other = result.first[seam.neighbour];
      std::vector<core::SeamPoint> common;
      eachSeamPoint(tile, other, seam.neighbour, [&](std::uint32_t here, std::uint32_t there) {
        common.push_back({first + here, first_of_other + there});
      });
      eachSeamPoint(other, tile, t, [&](std::uint32_t there, std::uint32_t here) {
        common.push_back({first + here, first_of_other + there});
      });
      segments.join(std::move(common), rule);
    }
  }
  result.numbers = segments.numbers(parameters.min_cluster_size, parameters.max_cluster_size);
  result.sizes.assign(1, 0);
  for (std::size_t s = 0; s < points.size(); ++s) {
    const auto number = static_cast<std::size_t>(result.numbers[s]);
    if (number == 0) continue;
    result.sizes.resize(std::max(result.sizes.size(), number + 1), 0);
    result.sizes[number] += points[s];
  }
  return result;
}

std::vector<std::int32_t> numbersOf(const SiteSegments& segments, const TileStore& store, std::size_t tile) {
  const ClusteredTile clustered = readClusters(store, tile);
  std::vector<std::int32_t> numbers;
  numbers.reserve(clustered.own.size());
  for (const std::uint32_t segment : clustered.own)
    numbers.push_back(segments.numbers[segments.first[tile] + segment]);
  return numbers;
}

}  // namespace pcl_fft_ground::cli
