// Aligns two overlapping scans of a survey by their segments, from where navigation puts them.

#include <pcl/point_types.h>

#include <iostream>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/segment_icp.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using pcl_fft_ground::core::SimulatedSubmap;

Cloud::Ptr cloudOf(const SimulatedSubmap& submap) {
  Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index i = 0; i < submap.scan.points.cols(); ++i)
    cloud->push_back({submap.scan.points(0, i), submap.scan.points(1, i), submap.scan.points(2, i)});
  return cloud;
}

pcl_fft_ground::GroundSegmentation<Point>::Ptr groundFilter() {
  const pcl_fft_ground::FFTGroundSegmentation<Point>::Ptr filter(
      new pcl_fft_ground::FFTGroundSegmentation<Point>);
  filter->setMaximumObjectSize(1.0);
  return filter;
}

int main() {
  pcl_fft_ground::core::SurveyParameters parameters;
  parameters.points = 100000;
  const pcl_fft_ground::core::SurveySimulation survey(parameters);
  const SimulatedSubmap target = survey.submap(0), source = survey.submap(1);
  const Eigen::Isometry3d guess = target.world_from_navigation.inverse() * source.world_from_navigation;
  const Eigen::Isometry3d truth = target.scan.world_from_scan.inverse() * source.scan.world_from_scan;

  pcl_fft_ground::SegmentICP<Point, Point> icp;
  icp.setInputSource(cloudOf(source));
  icp.setInputTarget(cloudOf(target));
  icp.setGroundSegmentation(groundFilter(), groundFilter());
  Cloud aligned;
  icp.align(aligned, guess.matrix().cast<float>());
  if (!icp.hasConverged()) {
    std::cerr << "refused: " << icp.getRefusal() << '\n';
    return 1;
  }
  const Eigen::Vector3d found = icp.getFinalTransformation().cast<double>().topRightCorner<3, 1>();
  const double before = (guess.translation() - truth.translation()).norm();
  const double after = (found - truth.translation()).norm();
  std::cout << icp.getMatches().size() << " matched segments, score " << icp.getScore() << "; off by "
            << 1000 * before << " mm before and " << 1000 * after << " mm after the alignment\n";
  return after < before ? 0 : 1;
}
