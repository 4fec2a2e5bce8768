// pcl::PCLPointCloud2: the contract, and what it does not say.

#include "message_cloud.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "contract_suite.h"
#include "sibling_traits.h"

namespace pcl_fft_ground::test {

using MessageSubjects = testing::Types<
    MessageSubject<FFTGroundSegmentation, pcl::PointXYZI>, MessageSubject<FFTGroundSegmentation, WidePoint>,
    MessageSubject<NaiveGroundSegmentation, WidePoint>, MessageSubject<PlanarGroundSegmentation, WidePoint>,
    MessageSubject<GridGroundSegmentation, WidePoint>, MessageSubject<GraphCutGroundSegmentation, WidePoint>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Messages, FilterContract, MessageSubjects);

namespace {

using Message = MessageCloud<WidePoint>;
using Segmenter = FFTGroundSegmentation<pcl::PCLPointCloud2>;

/// UTM coordinates, of which a float holds half a metre.
const Eigen::Vector3d FAR_AWAY(500123, 6000456, 30);

Message::Ptr boxesAt(const Eigen::Vector3d& place) {
  Message::Ptr cloud = cloudOf<InMessage<WidePoint>>(boxScene());
  for (WidePoint& p : *cloud) {
    p.x += place.x();
    p.y += place.y();
    p.z += place.z();
  }
  return cloud;
}

template <typename SegmenterT>
void setUp(SegmenterT& segmenter, const pcl::PCLPointCloud2::ConstPtr& cloud) {
  SegmenterTraits<FFTGroundSegmentation>::setUp(segmenter);
  segmenter.setInputCloud(cloud);
}

pcl::Indices objectsOf(const pcl::PCLPointCloud2::ConstPtr& cloud) {
  Segmenter segmenter;
  setUp(segmenter, cloud);
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  EXPECT_EQ(segmenter.getError(), "");
  return objects.indices;
}

TEST(MessageCloud, DoublesKeepTheirDetailFarFromTheOrigin) {
  // Translations by whole metres are exact in the scene.
  const Message::Ptr near = boxesAt(Eigen::Vector3d::Zero()), far = boxesAt(FAR_AWAY);
  const pcl::Indices expected = objectsOf(near);
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(objectsOf(far), expected);
}

TEST(MessageCloud, FrameAndSurfaceTakeCoordinatesAsTheyAre) {
  Segmenter near, far;
  const Message::Ptr near_cloud = boxesAt(Eigen::Vector3d::Zero()), far_cloud = boxesAt(FAR_AWAY);
  setUp(near, near_cloud);
  setUp(far, far_cloud);
  pcl::Indices objects;
  near.filter(objects);
  far.filter(objects);
  const Eigen::Vector3d place(1.5, 1.25, 0.3);
  EXPECT_NEAR((near.getFrame() * place - far.getFrame() * (place + FAR_AWAY)).norm(), 0, 1e-8);
  EXPECT_NEAR(near.getGroundSurface().heightAbove(place),
              far.getGroundSurface().heightAbove(place + FAR_AWAY), 1e-6);
  const std::vector<double> heights = near.getHeightAboveGround(), far_heights = far.getHeightAboveGround();
  ASSERT_EQ(far_heights.size(), heights.size());
  for (std::size_t n = 0; n < heights.size(); ++n) ASSERT_NEAR(far_heights[n], heights[n], 1e-6) << n;
  EXPECT_LT((near.getLevelPoints() - far.getLevelPoints()).cwiseAbs().maxCoeff(), 1e-5F);
}

TEST(MessageCloud, TheSensorStandsInTheCoordinatesOfTheCloud) {
  // Upside down: only the sensor, on the other side, tells.
  const Message::Ptr cloud = boxesAt(Eigen::Vector3d::Zero());
  for (WidePoint& p : *cloud) {
    p.x = FAR_AWAY.x() + p.x;
    p.y = FAR_AWAY.y() - p.y;
    p.z = FAR_AWAY.z() - p.z;
  }
  Segmenter segmenter;
  setUp(segmenter, cloud);
  segmenter.setSensorPosition(FAR_AWAY + Eigen::Vector3d(2, -1, -20));
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  EXPECT_LT(segmenter.getUp().axis.z(), -0.9);
  EXPECT_EQ(objects.indices, objectsOf(boxesAt(Eigen::Vector3d::Zero())));
}

TEST(MessageCloud, APointTypeWithDoublesKeepsTheirDetailToo) {
  pcl::PointCloud<WidePoint>::Ptr cloud(new pcl::PointCloud<WidePoint>);
  const auto boxes = boxesAt(FAR_AWAY);
  for (const WidePoint& p : *boxes) cloud->push_back(p);
  const impl::IndexedPoints<WidePoint> points(*cloud, nullptr);
  EXPECT_NEAR((points.origin() - FAR_AWAY).head<2>().norm(), 0, 5);
  const Eigen::Vector3d first(cloud->front().x, cloud->front().y, cloud->front().z);
  EXPECT_EQ(points.rawPoints(points.origin()).col(0), (first - points.origin()).cast<float>());
}

TEST(MessageCloud, RowsMayBePadded) {
  const Message::Ptr tight = boxesAt(FAR_AWAY);
  const pcl::PCLPointCloud2::Ptr padded(new pcl::PCLPointCloud2(*tight));
  constexpr std::size_t PADDING = 12;
  padded->row_step = static_cast<pcl::uindex_t>(tight->width * sizeof(WidePoint) + PADDING);
  padded->data.assign(std::size_t{padded->row_step} * tight->height, 0xFF);
  for (std::size_t row = 0; row < tight->height; ++row)
    std::memcpy(&padded->data[row * padded->row_step], &(*tight)[row * tight->width],
                tight->width * sizeof(WidePoint));
  EXPECT_EQ(objectsOf(padded), objectsOf(tight));

  Segmenter segmenter;
  setUp(segmenter, padded);
  Message objects, expected;
  segmenter.filter(objects);
  segmenter.setInputCloud(tight);
  segmenter.filter(expected);
  EXPECT_TRUE(sameClouds(objects, expected));
  EXPECT_EQ(objects.row_step, objects.width * objects.point_step);
}

/// A cloud that cannot be read is an error with an empty result.
void expectRefused(const pcl::PCLPointCloud2& cloud, const std::string& reason) {
  Segmenter segmenter(true);
  setUp(segmenter, pcl::make_shared<pcl::PCLPointCloud2>(cloud));
  for (const bool keep_organized : {false, true}) {
    segmenter.setKeepOrganized(keep_organized);
    const OutputCapture capture;
    Message output;
    EXPECT_NO_THROW(segmenter.filter(output));
    EXPECT_TRUE(output.empty());
    EXPECT_NE(segmenter.getError().find(reason), std::string::npos) << segmenter.getError();
    EXPECT_NE(capture.standard_error.text().find(reason), std::string::npos);
  }
  pcl::PointIndices ground, objects;
  const OutputCapture capture;
  EXPECT_NO_THROW(segmenter.segment(ground, objects));
  EXPECT_TRUE(ground.indices.empty() && objects.indices.empty());
  EXPECT_TRUE(segmenter.getHeightAboveGround().empty());
  EXPECT_EQ(segmenter.getLevelPoints().cols(), 0);
}

TEST(MessageCloud, WithoutCoordinatesIsRefused) {
  pcl::PCLPointCloud2 cloud = *boxesAt(FAR_AWAY);
  cloud.fields[1].name = "easting";
  expectRefused(cloud, "lacks one of the fields x, y and z");
}

TEST(MessageCloud, CoordinatesOfOtherTypesAreRefused) {
  const pcl::PCLPointCloud2 cloud = *boxesAt(FAR_AWAY);
  pcl::PCLPointCloud2 integers = cloud, mixed = cloud;
  for (std::size_t n = 1; n <= 3; ++n) integers.fields[n].datatype = pcl::PCLPointField::INT32;
  mixed.fields[2].datatype = pcl::PCLPointField::FLOAT32;
  expectRefused(integers, "neither all float32 nor all float64");
  expectRefused(mixed, "neither all float32 nor all float64");
}

TEST(MessageCloud, DataShorterThanItSaysIsRefused) {
  const pcl::PCLPointCloud2 cloud = *boxesAt(FAR_AWAY);
  pcl::PCLPointCloud2 truncated = cloud, beyond = cloud, higher = cloud;
  truncated.data.pop_back();
  beyond.fields[3].offset = beyond.point_step - 7;
  ++higher.height;
  for (const pcl::PCLPointCloud2& bad : {truncated, beyond, higher}) expectRefused(bad, "less data than");
}

TEST(MessageCloud, DoublesBeyondAFloatAreFar) {
  const Message::Ptr cloud = boxesAt(Eigen::Vector3d::Zero());
  (*cloud)[1000].x = 1e300;
  (*cloud)[1001].z = -1e300;
  Segmenter segmenter;
  setUp(segmenter, cloud);
  const OutputCapture capture;
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  EXPECT_EQ(segmenter.getFarPoints(), (pcl::Indices{1000, 1001}));
  EXPECT_EQ(ground.indices.size() + objects.indices.size(), cloud->size());
}

}  // namespace
}  // namespace pcl_fft_ground::test
