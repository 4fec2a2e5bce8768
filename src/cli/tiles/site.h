#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/cloud_parts.h"
#include "io/cloud_stream.h"
#include "pcl_fft_ground/core/ground/robust_ground.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/tiles/site_summary.h"
#include "pcl_fft_ground/core/tiles/tiling.h"
#include "tiles/tile_store.h"

namespace pcl_fft_ground::cli {

/// What a run by tiles is asked for.
struct SiteRequest {
  core::FrameParameters frame;
  core::RobustParameters robust;
  std::optional<Eigen::Vector3d> sensor;  ///< in the coordinates of the file [m]
  double tile_size = 0;                   ///< [m]
  std::string settings;  ///< all that results hang on, as text: a run goes on only where it is the same
};

/// What all tiles of a site have in common.
struct Site {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< subtracted from the coordinates of the file [m]
  core::SiteBounds bounds{core::Bounds()};
  core::UpDirection up;
  Eigen::Isometry3d frame_from_input = Eigen::Isometry3d::Identity();
  core::Bounds input_bounds;            ///< of the points that are used [m]
  core::Bounds level_bounds;            ///< of the points that are used, in the level frame
  std::uint64_t used = 0, far = 0;      ///< points
  std::uint64_t sum = 0;                ///< of the coordinates: whether the file is still the same
  std::optional<LabelMeaning> meaning;  ///< of the file's labels
  std::string label_fault;              ///< why there is none
  std::vector<std::uint64_t> points_of_tile, samples_of_tile;

  core::RobustPlan plan;  ///< follows from the above
  core::Tiling tiling{core::GridGeometry(), 1, 0};
};

/// Told the share of a piece of work that is done, from 0 to 1.
using Advance = std::function<void(double)>;

/// The points of a part of a site, as their file has them and relative to the origin.
struct SitePart {
  Cloud cloud;
  std::vector<double> labels;  ///< numbers of the label field; empty without one
};

/// Goes through all points of a stream, part by part.
void eachPart(CloudStream& stream, const Eigen::Vector3d& origin,
              const std::function<void(std::size_t first, SitePart part)>& visit, const Advance& advance);

/// Adds the coordinates of points to a sum that tells whether a file is still the same.
std::uint64_t sumWith(std::uint64_t sum, const pcl::PointCloud<pcl::PointXYZ>& points);

/// The points of a cloud as the core has them.
core::RawPoints rawPoints(const pcl::PointCloud<pcl::PointXYZ>& points);

/** The site that a run that was cut off has found, or the one that is found now, its points sorted into the
 * store.
 * \throws WorkError naming the file, or the store if it holds a run of another file or with other settings
 */
Site prepareSite(CloudStream& stream, const ReadOptions& reading, const SiteRequest& request,
                 const TileStore& store, const Advance& advance);

}  // namespace pcl_fft_ground::cli
