#include "point_array.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/scan/point_statistics.h"

namespace pcl_fft_ground::python {
namespace {

namespace py = pybind11;

std::string shapeOf(const py::array& array) {
  std::string text;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += (axis == 0 ? "" : " x ") + std::to_string(array.shape(axis));
  return array.ndim() == 0 ? "a single number" : text;
}

template <typename Number>
PointArray copy(const py::array& xyz) {
  const auto numbers = xyz.unchecked<Number, 2>();
  const auto count = static_cast<std::size_t>(numbers.shape(0));
  PointArray result;
  for (py::ssize_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values(count);
    for (std::size_t n = 0; n < count; ++n)
      values[n] = static_cast<double>(numbers(static_cast<py::ssize_t>(n), axis));
    result.origin[axis] = core::wholeOrigin(std::move(values));
  }
  result.points = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  result.points->resize(count);
  for (std::size_t n = 0; n < count; ++n)
    for (py::ssize_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(numbers(static_cast<py::ssize_t>(n), axis));
      float& coordinate = (*result.points)[n].data[axis];
      coordinate = static_cast<float>(value - result.origin[axis]);
      if (!std::isfinite(coordinate)) result.points->is_dense = false;
    }
  return result;
}

}  // namespace

PointArray toPoints(const py::array& xyz, const char* name) {
  if (xyz.ndim() != 2 || xyz.shape(1) != 3)
    throw std::invalid_argument(std::string(name) + " is " + shapeOf(xyz) +
                                ": allowed is an array of N x 3 numbers, a row for each point");
  if (py::isinstance<py::array_t<float>>(xyz)) return copy<float>(xyz);
  if (py::isinstance<py::array_t<double>>(xyz)) return copy<double>(xyz);
  throw std::invalid_argument(std::string(name) + " holds " + std::string(py::str(xyz.dtype())) +
                              ": allowed is float32 or float64");
}

}  // namespace pcl_fft_ground::python
