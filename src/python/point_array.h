#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pybind11/numpy.h>

#include <Eigen/Core>

namespace pcl_fft_ground::python {

/// A scan as the filters want it.
struct PointArray {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;        ///< row n of the array, less the origin
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< core::wholeOrigin() of the coordinates
};

/** Copies an N x 3 array of float32 or float64, of whatever strides.
 * \param name of the parameter, for messages
 * \throws std::invalid_argument (Python: ValueError) for other shapes and types
 */
PointArray toPoints(const pybind11::array& xyz, const char* name);

}  // namespace pcl_fft_ground::python
