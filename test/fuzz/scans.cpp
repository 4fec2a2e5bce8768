#include <pcl/exceptions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <memory>

#include "clouds.h"
#include "every_method.h"
#include "fuzz.h"
#include "pcl_fft_ground/object_cluster_extraction.h"
#include "pcl_fft_ground/relief_alignment.h"
#include "pcl_fft_ground/segment_icp.h"
#include "pcl_fft_ground/voxel_cluster_extraction.h"

namespace pcl_fft_ground::fuzz {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

bool isFinite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Points scattered within metres, an eighth of them with a coordinate of any value at all.
void addScattered(Bytes& bytes, Cloud& cloud) {
  constexpr float CENTIMETRES = 0.01F;
  while (!bytes.empty()) {
    Point point;
    for (int axis = 0; axis < 3; ++axis) point.data[axis] = CENTIMETRES * bytes.take<std::int8_t>();
    const auto choice = bytes.take<std::uint8_t>();
    if (choice >= 224) point.data[choice % 3] = bytes.take<float>();
    cloud.push_back(point);
  }
}

/// A floor of 1.5 m x 1.5 m with boxes on it, four bytes each, that slopes and is somewhat rough.
void addBoxes(Bytes& bytes, Cloud& cloud) {
  constexpr int SIDE = 30;
  constexpr float STEP = 0.05F;
  struct Box {
    int x, y, width;
    float height;
  };
  const float slope = 0.001F * bytes.take<std::int8_t>(), roughness = 0.0001F * bytes.take<std::uint8_t>();
  std::vector<Box> boxes;
  for (unsigned count = bytes.take<std::uint8_t>() % 8; count > 0; --count) {
    const auto x = bytes.take<std::uint8_t>(), y = bytes.take<std::uint8_t>(),
               width = bytes.take<std::uint8_t>();
    boxes.push_back({x % SIDE, y % SIDE, 1 + width % 8, 0.01F * bytes.take<std::int8_t>()});
  }
  for (int x = 0; x < SIDE; ++x)
    for (int y = 0; y < SIDE; ++y) {
      float z = slope * static_cast<float>(x) + roughness * static_cast<float>((37 * x + 91 * y) % 17);
      for (const Box& box : boxes)
        if (std::abs(x - box.x) < box.width && std::abs(y - box.y) < box.width) z += box.height;
      cloud.emplace_back(STEP * static_cast<float>(x), STEP * static_cast<float>(y), z);
    }
}

Cloud::Ptr takeCloud(Bytes& bytes) {
  const auto cloud = pcl::make_shared<Cloud>();
  const auto kind = bytes.take<std::uint8_t>();
  if (kind % 4 != 0) addBoxes(bytes, *cloud);
  if (kind % 4 != 1) addScattered(bytes, *cloud);
  cloud->is_dense = false;
  return cloud;
}

/// A number for a setter: of any size, or one that suits the scans.
double takeNumber(Bytes& bytes) {
  return bytes.take<std::uint8_t>() % 4 == 0 ? bytes.take<double>() : 0.01 * bytes.take<std::int16_t>();
}

/// Calls a setter, which may refuse the number.
template <typename Setter>
void trySetting(Bytes& bytes, const Setter& set) {
  try {
    set(takeNumber(bytes));
  } catch (const pcl::PCLException&) {
    // as promised
  }
}

/// Each finite point is in one of the lists, at most, and no other is in any.
void requireParts(const Cloud& cloud, const std::vector<pcl::PointIndices>& lists, bool all) {
  std::vector<int> times(cloud.size(), 0);
  for (const pcl::PointIndices& list : lists)
    for (const pcl::index_t n : list.indices) ++times.at(static_cast<std::size_t>(n));
  for (std::size_t n = 0; n < times.size(); ++n)
    require(times[n] <= (isFinite(cloud[n]) ? 1 : 0) && (!all || times[n] == (isFinite(cloud[n]) ? 1 : 0)),
            "each finite point is in one part");
}

Eigen::Vector3d takeVector(Bytes& bytes) {
  Eigen::Vector3d vector;
  for (double& number : vector) number = takeNumber(bytes);
  return vector;
}

/// The numbers for the setters stand in the first bytes, the points behind them.
Bytes takeSettings(Bytes& bytes) {
  constexpr std::size_t SETTINGS = 96;
  const std::string_view all = bytes.rest();
  bytes = Bytes(all.substr(std::min(SETTINGS, all.size())));
  return Bytes(all.substr(0, SETTINGS));
}

/// In units of the cloud: finer ones are right, but take their time.
constexpr double FINEST_CELL = 0.005;

/// Every method with any settings.
void segmentation(Bytes bytes) {
  static const std::vector<test::Method<Point>> methods = test::everyMethod<Point>();
  Bytes settings = takeSettings(bytes);
  const Cloud::Ptr cloud = takeCloud(bytes);
  const double unit = test::unitOf(*cloud);
  const auto choice = settings.take<std::uint8_t>();
  const auto filter = methods[settings.take<std::uint8_t>() % methods.size()].make(unit);
  const auto set = [&](unsigned bit, const auto& setter) {
    if ((choice & bit) != 0) trySetting(settings, setter);
  };
  const Eigen::Vector3d up = takeVector(settings), sensor = takeVector(settings);
  set(1, [&](double v) { filter->setHeightTolerance(v); });
  set(2, [&](double) { filter->setUpDirection(up); });
  set(4, [&](double) { filter->setSensorPosition(sensor); });
  if (auto* const fft = dynamic_cast<FFTGroundSegmentation<Point>*>(filter.get())) {
    set(8, [&](double v) { fft->setMaximumObjectSize(v); });
    set(16, [&](double v) { fft->setCellSize(std::max(v, FINEST_CELL) * unit); });
    set(32, [&](double v) { fft->setMaximumSlope(v); });
    set(64, [&](double v) { fft->setFinestWavelength(v * unit); });
    set(128, [&](double v) { fft->setRelativeMaximumObjectSize(v); });
  }
  filter->setInputCloud(cloud);
  std::vector<pcl::PointIndices> parts(2);
  filter->segment(parts[0], parts[1]);
  requireParts(*cloud, parts, true);
  require(filter->getGroundSurface().height.allFinite(), "the ground is finite");
}

template <typename Extraction>
void requireClusters(Extraction extraction, const Cloud::Ptr& cloud) {
  std::vector<pcl::PointIndices> clusters;
  extraction.setInputCloud(cloud);
  extraction.extract(clusters);
  requireParts(*cloud, clusters, extraction.getMinClusterSize() <= 1);
}

/// Both ways to find clusters, with any settings.
void clusters(Bytes bytes) {
  VoxelClusterExtraction<Point> contact;
  ObjectClusterExtraction<Point> objects;
  trySetting(bytes, [&](double v) { contact.setLeafSize(v); });
  trySetting(bytes, [&](double v) { objects.setLeafSize(v); });
  trySetting(bytes, [&](double v) { objects.setMinimumObjectSize(v); });
  const Eigen::Vector3d up = takeVector(bytes);
  trySetting(bytes, [&](double) { objects.setUpDirection(up); });
  const auto least = bytes.take<std::uint8_t>();
  contact.setMinClusterSize(least);
  objects.setMinClusterSize(least);
  const Cloud::Ptr cloud = takeCloud(bytes);
  requireClusters(contact, cloud);
  requireClusters(objects, cloud);
}

/// A motion by up to a metre and two radians.
Eigen::Affine3f takeMotion(Bytes& bytes) {
  Eigen::Vector3f shift;
  for (float& coordinate : shift) coordinate = 0.01F * bytes.take<std::int8_t>();
  const float turn = 0.02F * bytes.take<std::int8_t>();
  return Eigen::Translation3f(shift) * Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ());
}

/// Aligns two scans from any guess: a rigid motion, or the guess itself with a reason.
template <typename Registration>
void requireMotion(Registration& registration, Bytes& bytes) {
  const Eigen::Affine3f guess = takeMotion(bytes), truth = takeMotion(bytes);
  const bool is_moved = bytes.take<std::uint8_t>() % 4 != 0;
  const auto half = bytes.take<std::uint8_t>();
  Bytes first(bytes.rest().substr(0, half));
  Bytes second(bytes.rest().substr(std::min<std::size_t>(half, bytes.rest().size())));
  const Cloud::Ptr target = takeCloud(first),
                   source = is_moved ? pcl::make_shared<Cloud>() : takeCloud(second);
  if (is_moved)
    for (const Point& p : *target) {
      Point moved;
      moved.getVector3fMap() = truth * p.getVector3fMap();
      source->push_back(moved);
    }
  source->is_dense = false;
  if (source->empty() || target->empty()) return;  // PCL's base class does not take them
  registration.setInputTarget(target);
  registration.setInputSource(source);
  Cloud aligned;
  registration.align(aligned, guess.matrix());
  const Eigen::Matrix4f motion = registration.getFinalTransformation();
  require(motion.allFinite(), "a motion is finite");
  require((motion.topLeftCorner<3, 3>() * motion.topLeftCorner<3, 3>().transpose()).isIdentity(1e-3F),
          "a motion is rigid");
  require(registration.hasConverged() == registration.getRefusal().empty(),
          "a reason is given where, and only where, a pair is refused");
  if (!registration.hasConverged()) require(motion.isApprox(guess.matrix(), 1e-3F), "a refused pair stays");
}

void segmentAlignment(Bytes bytes) {
  SegmentICP<Point, Point> registration;
  const auto choice = bytes.take<std::uint8_t>();
  registration.setSearchMode(choice % 2 == 0 ? core::SearchMode::NAVIGATION : core::SearchMode::WIDE);
  if ((choice & 2) != 0) trySetting(bytes, [&](double v) { registration.setMinScore(v); });
  if ((choice & 4) != 0) trySetting(bytes, [&](double v) { registration.setMaxSigma(v); });
  if ((choice & 8) != 0) registration.setMinMatches(1 + bytes.take<std::uint8_t>() % 4);
  requireMotion(registration, bytes);
}

void reliefAlignment(Bytes bytes) {
  ReliefAlignment<Point, Point> registration;
  const auto choice = bytes.take<std::uint8_t>();
  if ((choice & 1) != 0) trySetting(bytes, [&](double v) { registration.setMaxShift(std::min(v, 2.0)); });
  if ((choice & 2) != 0) trySetting(bytes, [&](double v) { registration.setMaxTurn(v); });
  if ((choice & 4) != 0) trySetting(bytes, [&](double v) { registration.setMaxRise(v); });
  if ((choice & 8) != 0) trySetting(bytes, [&](double v) { registration.setCellSize(std::max(v, 0.02)); });
  requireMotion(registration, bytes);
}

}  // namespace

std::vector<Target> scanTargets() {
  return {{"segmentation", segmentation},
          {"clusters", clusters},
          {"segment-alignment", segmentAlignment},
          {"relief-alignment", reliefAlignment}};
}

}  // namespace pcl_fft_ground::fuzz
