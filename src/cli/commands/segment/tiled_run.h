#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "commands/segment/tiled_segment.h"
#include "pcl_fft_ground/simulation/evaluation.h"
#include "tiles/tile_store.h"
#include "tiles/tile_work.h"

// What the steps of `segment --tile` share once the tiles are labelled and clustered.
namespace pcl_fft_ground::cli {

/// A file that is written bit by bit and gets its place when it is complete.
class GrowingFile {
 public:
  GrowingFile(const TileStore& store, const std::string& directory, const std::string& name)
      : part_(store.path(name + ".part")), path_(directory + "/" + name), stream_(part_, std::ios::binary) {}

  void write(const char* bytes, std::size_t count);
  void write(const std::string& text) { write(text.data(), text.size()); }
  void write(const pcl::PCLPointCloud2& points) {
    write(reinterpret_cast<const char*>(points.data.data()), points.data.size());
  }
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::string part_, path_;
  std::ofstream stream_;
};

/// All that the steps after clustering work on.
struct TiledRun {
  CloudStream& stream;
  const std::string& directory;
  const TiledRequest& request;
  const TileStore& store;
  const Site& site;
  const SiteGround& ground;
  const SiteSegments& segments;
};

/// What the outputs in the order of the file tell.
struct PointOutputs {
  PointCounts counts;
  std::optional<core::Confusion> confusion;
};

/// Writes labelled.pcd, ground.pcd and objects.pcd, and labelled.las of a LAS file.
PointOutputs writePoints(const TiledRun& run, const PointCounts& expected, CellViews& views,
                         const Advance& advance);

}  // namespace pcl_fft_ground::cli
