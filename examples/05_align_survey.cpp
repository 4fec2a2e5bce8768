// Makes a map of a survey while it is under way: each sub-map is aligned with those before it that it
// overlaps, and the poses around it are refined.

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

  // Root mean square errors of the poses, once they are laid on the true ones as a whole.
  std::vector<Eigen::Isometry3d> truth;
  const auto millimetres = [&](const std::vector<Eigen::Isometry3d>& poses) {
    return 1000 * core::poseErrors(survey.getScans(), truth, poses).rms_translation;
  };
  for (std::size_t i = 0; i < 10; ++i) {
    const core::SimulatedSubmap submap = simulation.submap(i);
    const std::size_t id = survey.addScan(cloudOf(submap.scan), submap.world_from_navigation);
    truth.push_back(submap.scan.world_from_scan);
    survey.update();
    std::cout << "scan " << id << " lies at " << survey.getPose(id).translation().transpose() << "; errors "
              << millimetres(survey.getPoses().navigation) << " mm by navigation, "
              << millimetres(survey.getPoses().global) << " mm on the map\n";
  }

  // All pairs that overlap, and all poses, at once: no worse, and what a survey is to be left with.
  survey.align();
  for (const core::PairResult& pair : survey.getPairs())
    if (pair.status != core::PairStatus::ALIGNED)
      std::cout << "scan " << pair.moving << " on scan " << pair.reference << ": " << pair.refusal << '\n';
  const double before = millimetres(survey.getPoses().navigation),
               after = millimetres(survey.getPoses().global);
  std::cout << survey.getPoses().edges << " aligned pairs; errors " << before << " mm by navigation, "
            << after << " mm at the end\n";
  return after < 0.1 * before ? 0 : 1;
}
