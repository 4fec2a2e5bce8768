#include "commands/survey/survey_report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_set>

#include "io/cloud_fields.h"
#include "io/cloud_file.h"
#include "io/output_file.h"
#include "methods/segmentation.h"
#include "pcl_fft_ground/core/align/crispness.h"
#include "pictures/pictures.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double MERGED_VOXEL = 0.01;  // [m]
constexpr double PICTURE_CELL = 0.02;  // of the pictures, more for large sites [m]
constexpr double MOST_CELLS = 3000;    // of the pictures along a side

/// The cubes of a lattice that points have fallen into.
class VoxelCount {
 public:
  explicit VoxelCount(double size) : size_(size) {}

  /// Whether the voxel of this place was empty before.
  bool add(const Eigen::Vector3d& place) {
    constexpr std::int64_t OFFSET = 1 << 20;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<std::int64_t>(std::floor(place[axis] / size_)) + OFFSET;
      key = (key << 21) | (static_cast<std::uint64_t>(index) & 0x1fffff);
    }
    return voxels_.insert(key).second;
  }
  std::size_t size() const { return voxels_.size(); }

 private:
  double size_;
  std::unordered_set<std::uint64_t> voxels_;
};

/// The highest point over each cell of the site.
class SitePicture {
 public:
  explicit SitePicture(const Eigen::AlignedBox2d& extent) {
    image_.cell_size = std::max(PICTURE_CELL, extent.sizes().maxCoeff() / MOST_CELLS);
    const Eigen::Array2i cells = (extent.sizes() / image_.cell_size).array().ceil().cast<int>() + 1;
    image_.values = Eigen::ArrayXXd::Constant(cells.x(), cells.y(), std::numeric_limits<double>::quiet_NaN());
    image_.origin = extent.min();
    image_.frame = "the world";
  }

  void add(const Eigen::Vector3d& place) {
    const Eigen::Array2d at = (place.head<2>() - image_.origin).array() / image_.cell_size;
    if ((at < 0).any() || at.x() >= static_cast<double>(image_.values.rows()) ||
        at.y() >= static_cast<double>(image_.values.cols()))
      return;
    double& height = image_.values(static_cast<Eigen::Index>(at.x()), static_cast<Eigen::Index>(at.y()));
    if (!(height >= place.z())) height = place.z();
  }
  const GridImage& image() const { return image_; }

 private:
  GridImage image_;
};

/// Where the sub-maps lie, by either poses.
Eigen::AlignedBox2d siteExtent(const SurveyFolder& survey, const core::SurveyPoses& poses) {
  Eigen::AlignedBox2d extent;
  for (std::size_t i = 0; i < survey.submaps.size(); ++i) {
    const core::GridGeometry& cells = survey.scans[i].coverage.geometry;
    for (const int corner : {0, 1, 2, 3}) {
      const double x = cells.origin.x() + (corner % 2) * static_cast<double>(cells.rows) * cells.cell_size;
      const double y = cells.origin.y() + (corner / 2) * static_cast<double>(cells.cols) * cells.cell_size;
      const Eigen::Vector3d place(x, y, survey.scans[i].centroid.z());
      extent.extend((poses.navigation[i] * place).head<2>());
      extent.extend((poses.global[i] * place).head<2>());
    }
  }
  return extent;
}

/// What is subtracted from the coordinates of the site, so that floats hold them: whole metres.
Eigen::Vector3d originOf(const SurveyFolder& survey, const core::SurveyPoses& poses) {
  const Eigen::Vector3d place = poses.global.front() * survey.scans.front().centroid;
  return (place.array().abs() > core::LARGE_COORDINATE).select(place.array().round(), 0.0);
}

/// All that is gathered while the sub-maps pass by.
struct Site {
  Site(const Eigen::AlignedBox2d& extent, const Eigen::Vector3d& subtracted)
      : origin(subtracted), before(extent), after(extent) {}

  void add(const core::Points& points, std::size_t submap, const core::SurveyPoses& poses) {
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Vector3d point = points.col(n).cast<double>();
      const Eigen::Vector3d by_navigation = poses.navigation[submap] * point;
      const Eigen::Vector3d place = poses.global[submap] * point;
      navigation.add(by_navigation);
      chained.add(poses.chained[submap] * point);
      global.add(place);
      before.add(by_navigation);
      after.add(place);
      if (!merged_voxels.add(place)) continue;
      merged.push_back((place - origin).cast<float>());
      merged_submaps.push_back(static_cast<std::int32_t>(submap));
    }
  }

  VoxelCount navigation{core::CRISPNESS_VOXEL}, chained{core::CRISPNESS_VOXEL}, global{core::CRISPNESS_VOXEL};
  Eigen::Vector3d origin;
  SitePicture before, after;
  VoxelCount merged_voxels{MERGED_VOXEL};
  std::vector<Eigen::Vector3f> merged;
  std::vector<std::int32_t> merged_submaps;
};

void writeMerged(const std::string& path, const Site& site) {
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) appendField(cloud, name, pcl::PCLPointField::FLOAT32, 1);
  allocatePoints(cloud, site.merged.size(), 1);
  for (std::size_t i = 0; i < site.merged.size(); ++i)
    std::memcpy(cloud.data.data() + i * cloud.point_step, site.merged[i].data(), sizeof(float) * 3);
  setInt32Field(cloud, "submap", site.merged_submaps);
  writePcd(path, cloud, {site.origin, Eigen::Quaterniond::Identity()});
}

void drawSite(const std::string& path, const std::string& title, const SitePicture& site,
              const std::optional<ValueRange>& range) {
  writeWhole(path, [&](const std::string& temporary) {
    drawHeights(temporary, title, site.image(), "height [m]", range);
  });
}

}  // namespace

SiteCrispness writeSiteMap(const std::string& folder, const SurveyFolder& survey,
                           const core::SurveyPoses& poses, const std::function<void(std::size_t)>& report) {
  Site site(siteExtent(survey, poses), originOf(survey, poses));
  for (std::size_t i = 0; i < survey.submaps.size(); ++i) {
    report(i + 1);
    site.add(usablePoints(*readCloud(survey.submaps[i].path).points).points, i, poses);
  }
  writeMerged(folder + "/merged.pcd", site);
  const std::optional<ValueRange> range = robustRange(site.after.image().values);
  drawSite(folder + "/site_before.png", "The site as navigation has it", site.before, range);
  drawSite(folder + "/site_after.png", "The site after global alignment", site.after, range);
  return {site.navigation.size(), site.chained.size(), site.global.size()};
}

}  // namespace pcl_fft_ground::cli
