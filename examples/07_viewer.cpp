// Shows a simulated wreck: its ground, its objects in a colour each, and the estimated ground as a mesh.
// The keys a, b and m switch these; h tells PCLVisualizer's own. With --screenshot FILE.png it only draws
// that.

#include <pcl/common/colors.h>
#include <pcl/visualization/pcl_visualizer.h>

#include <map>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/simulation/simulation.h"

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using ColourCloud = pcl::PointCloud<pcl::PointXYZRGB>;

void addPoints(ColourCloud& cloud, const Cloud& scan, const pcl::Indices& indices, const pcl::RGB& colour) {
  for (const pcl::index_t n : indices)
    cloud.push_back({scan[n].x, scan[n].y, scan[n].z, colour.r, colour.g, colour.b});
}

/// The middles of the surface's cells, with a square between each four of them.
pcl::PolygonMesh meshOf(const pcl_fft_ground::core::GroundSurface& surface) {
  const Eigen::Isometry3d input_from_frame = surface.frame_from_input.inverse();
  const auto rows = static_cast<pcl::index_t>(surface.height.rows()),
             cols = static_cast<pcl::index_t>(surface.height.cols());
  Cloud corners;
  pcl::PolygonMesh mesh;
  for (pcl::index_t i = 0; i < rows; ++i)
    for (pcl::index_t j = 0; j < cols; ++j) {
      const Eigen::Vector2d middle =
          surface.geometry.origin + surface.geometry.cell_size * Eigen::Vector2d(i + 0.5, j + 0.5);
      const Eigen::Vector3d place =
          input_from_frame * Eigen::Vector3d(middle.x(), middle.y(), surface.height(i, j));
      corners.emplace_back(place.x(), place.y(), place.z());
      if (i == 0 || j == 0) continue;
      const pcl::index_t n = i * cols + j;
      mesh.polygons.emplace_back();
      mesh.polygons.back().vertices = {n - cols - 1, n - cols, n, n - 1};
    }
  pcl::toPCLPointCloud2(corners, mesh.cloud);
  return mesh;
}

int main(int argc, char** argv) {
  const bool only_draw = argc == 3 && std::string(argv[1]) == "--screenshot";
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.points = 200000;
  const Eigen::Matrix3Xf points = pcl_fft_ground::core::simulateScan(parameters).points;
  const Cloud::Ptr scan(new Cloud);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    scan->emplace_back(points(0, i), points(1, i), points(2, i));

  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setMaximumObjectSize(1.0);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);
  pcl_fft_ground::ObjectClusterExtraction<pcl::PointXYZ> clustering;
  clustering.setInputCloud(scan);
  clustering.setIndices(pcl::make_shared<pcl::PointIndices>(objects));
  clustering.setLeafSize(filter.getCellSize());
  clustering.setHeightAboveGround(filter.getHeightAboveGround());
  std::vector<pcl::PointIndices> segments;
  clustering.extract(segments);

  std::map<std::string, ColourCloud::Ptr> clouds{{"a", ColourCloud::Ptr(new ColourCloud)},
                                                 {"b", ColourCloud::Ptr(new ColourCloud)}};
  addPoints(*clouds["a"], *scan, ground.indices, pcl::RGB(150, 140, 125));
  for (std::size_t k = 0; k < segments.size(); ++k)
    addPoints(*clouds["b"], *scan, segments[k].indices, pcl::GlasbeyLUT::at(k % pcl::GlasbeyLUT::size()));

  pcl::visualization::PCLVisualizer viewer("ground (a), objects (b), estimated ground (m)");
  viewer.setBackgroundColor(1, 1, 1);
  viewer.setSize(1000, 750);
  for (const auto& [key, cloud] : clouds) viewer.addPointCloud<pcl::PointXYZRGB>(cloud, key);
  viewer.addPolygonMesh(meshOf(filter.getGroundSurface()), "m");
  viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_COLOR, 0.35, 0.6, 0.4, "m");
  viewer.setCameraPosition(3.6, -6, 4.8, 0, 0, 0, 0, 0, 1);
  std::map<std::string, bool> hidden;
  viewer.registerKeyboardCallback([&](const pcl::visualization::KeyboardEvent& event) {
    const std::string key = event.getKeySym();
    if (!event.keyDown() || (key != "m" && clouds.count(key) == 0)) return;
    hidden[key] = !hidden[key];
    viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_OPACITY, hidden[key] ? 0 : 1,
                                            key);
  });
  if (!only_draw) viewer.spin();
  if (only_draw) viewer.saveScreenshot(argv[2]);
  return segments.empty() ? 1 : 0;
}
