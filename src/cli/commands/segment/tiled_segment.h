#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/segment/segment_outputs.h"
#include "io/cloud_stream.h"
#include "methods/segmentation.h"
#include "progress.h"
#include "tiles/site.h"

namespace pcl_fft_ground::cli {

/// What `segment --tile` is asked for.
struct TiledRequest {
  SiteRequest site;
  ReadOptions reading;
  RasterOptions raster;
  LasClasses classes;
  bool heights = false;                               ///< whether labelled.pcd gets them
  std::function<ClusterParameters(double)> clusters;  ///< for a cell size [m]
  /// The parameters of the report, for those of the clusters. \param choices what was chosen from the data
  std::function<nlohmann::ordered_json(const ClusterParameters&,
                                       const std::vector<core::RobustChoice>& choices)>
      parameters;
};

/** Segments a cloud tile by tile, its points never all in memory: the same files as for a cloud that is held
 * whole. Goes on where a run was cut off.
 * \return the content of report.json, which is still to be written; then `forget` removes the tiles
 */
nlohmann::ordered_json segmentByTiles(CloudStream& stream, const std::string& directory,
                                      const std::string& method, const TiledRequest& request,
                                      Progress& progress);

/// Removes what a run by tiles leaves in the directory until it has ended.
void forgetTiles(const std::string& directory);

}  // namespace pcl_fft_ground::cli
