// Reads back what the segmentation found out on its way: frame, elevation, spectrum, cut-off and ground
// surface.

#include <pcl/point_types.h>

#include <algorithm>
#include <iostream>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/simulation/simulation.h"

int main() {
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.points = 200000;
  const Eigen::Matrix3Xf points = pcl_fft_ground::core::simulateScan(parameters).points;
  pcl::PointCloud<pcl::PointXYZ>::Ptr scan(new pcl::PointCloud<pcl::PointXYZ>);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    scan->push_back({points(0, i), points(1, i), points(2, i)});

  pcl_fft_ground::FFTGroundSegmentation<pcl::PointXYZ> filter;
  filter.setInputCloud(scan);
  filter.setMaximumObjectSize(1.0);
  pcl::PointIndices ground, objects;
  filter.segment(ground, objects);

  const auto& elevation = filter.getElevationGrid();
  std::cout << "elevation: " << elevation.geometry.rows << " x " << elevation.geometry.cols << " cells, "
            << 100 * filter.getEmptyCellShare() << " % of them empty\n";
  std::cout << "cut-off:   f_c = " << filter.getCutoffFrequency()
            << ", m_c = " << filter.getCutoff().object_size << " m, one of "
            << filter.getSpectrumPeaks().size() << " peaks\n";
  std::cout << "magnitude of the largest bin beside DC, before and after the filter: ";
  for (const auto& spectrum : {filter.getSpectrum(), filter.getFilteredSpectrum()}) {
    Eigen::ArrayXXd magnitude = pcl_fft_ground::core::magnitude(spectrum);
    magnitude(0, 0) = 0;
    std::cout << magnitude.maxCoeff() << ' ';
  }

  const auto& surface = filter.getGroundSurface();
  std::cout << "\nground:    from " << surface.height.minCoeff() << " m to " << surface.height.maxCoeff()
            << " m in the level frame\n";
  double highest = 0;
  for (const pcl::index_t i : objects.indices)
    highest = std::max(highest, surface.heightAbove((*scan)[i].getVector3fMap().cast<double>()));
  std::cout << "objects:   " << objects.indices.size() << " points, up to " << highest
            << " m above the ground\n";
  return objects.indices.empty() ? 1 : 0;
}
