// Two flight lines of an airborne laser over one town, aligned by SegmentICP and by PCL's generalised ICP.
// They are not part of the project: without PCL_FFT_GROUND_DATA this test is skipped.

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include <cstdlib>
#include <string>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/segment_icp.h"

namespace pcl_fft_ground {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

const Eigen::Vector4f AMID(75, 36, 28, 1);  // of what both lines have seen

Cloud::Ptr flightLine(int number) {
  const char* data = std::getenv("PCL_FFT_GROUND_DATA");
  const Cloud::Ptr cloud(new Cloud);
  if (data != nullptr)
    pcl::io::loadPCDFile(
        std::string(data) + "/strips/ign_dense_urban_strip" + std::to_string(number) + ".pcd", *cloud);
  return cloud;
}

GroundSegmentation<Point>::Ptr groundFilter() {
  const FFTGroundSegmentation<Point>::Ptr filter(new FFTGroundSegmentation<Point>);
  filter->setMaximumObjectSize(20);
  return filter;
}

/// Where the middle of the scans is shifted to, starting from the frame of the files.
Eigen::Vector3f shiftBy(pcl::Registration<Point, Point>& registration, const Cloud::Ptr& source,
                        const Cloud::Ptr& target) {
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud aligned;
  registration.align(aligned);
  EXPECT_TRUE(registration.hasConverged());
  return (registration.getFinalTransformation() * AMID - AMID).head<3>();
}

TEST(FlightLinesPeer, GeneralizedIcpMovesTheLinesToTheSamePlace) {
  const Cloud::Ptr source = flightLine(707), target = flightLine(706);
  if (source->empty() || target->empty()) GTEST_SKIP() << "PCL_FFT_GROUND_DATA names no folder of real scans";

  SegmentICP<Point, Point> icp;
  icp.setGroundSegmentation(groundFilter(), groundFilter());
  const Eigen::Vector3f ours = shiftBy(icp, source, target);

  pcl::GeneralizedIterativeClosestPoint<Point, Point> peer;
  peer.setMaxCorrespondenceDistance(1.0);
  const Eigen::Vector3f theirs = shiftBy(peer, source, target);

  EXPECT_GT(theirs.norm(), 0.05) << "the lines are apart in the files";
  EXPECT_LT((ours - theirs).norm(), 0.04) << ours.transpose() << " and " << theirs.transpose();
}

}  // namespace
}  // namespace pcl_fft_ground
