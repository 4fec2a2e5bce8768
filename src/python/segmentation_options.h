#pragma once

#include <pcl/point_types.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground::python {

using Filter = GroundSegmentation<pcl::PointXYZ>;

/** The segmenter of a method, its options set.
 * \param method as the command spells it: "fft", "fft-lowpass", "naive", "planar", "grid" or "graph-cut"
 * \param options keyword arguments, named as the command's options with _ for -; None is as if not given.
 * Those that are taken are removed.
 * \throws std::invalid_argument (Python: ValueError) naming the parameter, its value and what is allowed
 */
std::unique_ptr<Filter> makeFilter(const std::string& method, pybind11::dict& options);

/// Adds align() to the module, where it is built with the component registration.
void defineAlignment(pybind11::module_& module);

}  // namespace pcl_fft_ground::python
