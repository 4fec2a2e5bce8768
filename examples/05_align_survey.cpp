// Makes one map of a survey: its sub-maps are aligned with each other, and their poses found from all pairs
// and the navigation at once.

#include <pcl/point_types.h>

#include <iostream>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/survey_simulation.h"
#include "pcl_fft_ground/survey_alignment.h"

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
namespace core = pcl_fft_ground::core;

Cloud::Ptr cloudOf(const core::SimulatedScan& scan) {
  Cloud::Ptr cloud(new Cloud);
  for (Eigen::Index i = 0; i < scan.points.cols(); ++i)
    cloud->push_back({scan.points(0, i), scan.points(1, i), scan.points(2, i)});
  return cloud;
}

int main() {
  core::SurveyParameters parameters;
  parameters.points = 50000;
  const core::SurveySimulation simulation(parameters);

  pcl_fft_ground::SurveyAlignment<Point> survey;
  const pcl_fft_ground::FFTGroundSegmentation<Point>::Ptr ground(
      new pcl_fft_ground::FFTGroundSegmentation<Point>);
  ground->setMaximumObjectSize(1.0);
  survey.setGroundSegmentation(ground);
  std::vector<Eigen::Isometry3d> truth;
  for (std::size_t i = 0; i < 6; ++i) {
    const core::SimulatedSubmap submap = simulation.submap(i);
    survey.addScan(cloudOf(submap.scan), submap.world_from_navigation);
    truth.push_back(submap.scan.world_from_scan);
  }
  survey.align();

  for (const core::PairResult& pair : survey.getPairs())
    std::cout << "scan " << pair.moving << " on scan " << pair.reference << ": "
              << (pair.refusal.empty() ? std::to_string(pair.matches) + " matched segments" : pair.refusal)
              << '\n';
  std::cout << "scan 1 lies at " << survey.getPose(1).translation().transpose() << '\n';

  const core::SurveyPoses& poses = survey.getPoses();
  const double before = core::poseErrors(survey.getScans(), truth, poses.navigation).rms_translation;
  const double after = core::poseErrors(survey.getScans(), truth, poses.global).rms_translation;
  std::cout << "root mean square error of the poses: " << 1000 * before << " mm by navigation, "
            << 1000 * after << " mm after the alignment\n";
  return after < 0.1 * before ? 0 : 1;
}
