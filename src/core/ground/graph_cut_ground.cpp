#include "pcl_fft_ground/core/ground/graph_cut_ground.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using VertexProperties =
    boost::property<boost::vertex_color_t, boost::default_color_type,
                    boost::property<boost::vertex_distance_t, long,
                                    boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>;
using EdgeProperties =
    boost::property<boost::edge_capacity_t, double,
                    boost::property<boost::edge_residual_capacity_t, double,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>;
using Graph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, VertexProperties, EdgeProperties>;

constexpr double MOST_GRAPH_CELLS = MAX_CELLS / 100;

/// Adds an edge and its reverse; BGL wants both for every edge.
void connect(Graph& graph, std::size_t a, std::size_t b, double capacity, double reverse_capacity) {
  const auto forward = boost::add_edge(a, b, graph).first, backward = boost::add_edge(b, a, graph).first;
  boost::put(boost::edge_capacity, graph, forward, capacity);
  boost::put(boost::edge_capacity, graph, backward, reverse_capacity);
  boost::put(boost::edge_reverse, graph, forward, backward);
  boost::put(boost::edge_reverse, graph, backward, forward);
}

/// Running minimum (or maximum, with std::greater) of a line within half_window places either side: monotone
/// queue.
template <typename Line, typename Before>
void runningExtreme(Line line, Eigen::Index half_window, const Before& before) {
  const Eigen::ArrayXd values = line;
  std::deque<Eigen::Index> candidates;
  for (Eigen::Index next = 0, i = 0; i < values.size(); ++i) {
    for (; next < std::min(values.size(), i + half_window + 1); ++next) {
      while (!candidates.empty() && !before(values[candidates.back()], values[next])) candidates.pop_back();
      candidates.push_back(next);
    }
    while (candidates.front() < i - half_window) candidates.pop_front();
    line[i] = values[candidates.front()];
  }
}

template <typename Before>
Eigen::ArrayXXd runningExtremes(Eigen::ArrayXXd values, Eigen::Index half_window, const Before& before) {
  for (Eigen::Index j = 0; j < values.cols(); ++j) runningExtreme(values.col(j), half_window, before);
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    runningExtreme(values.row(i).transpose(), half_window, before);
  return values;
}

/// D(ground) of every cell; D(object) is the rest to 1.
Eigen::ArrayXXd groundCosts(const ElevationGrid& grid, const GraphCutParameters& parameters) {
  const double half_window = std::ceil(0.5 * parameters.max_object_size / parameters.cell_size);
  const auto longest = static_cast<double>(std::max(grid.elevation.rows(), grid.elevation.cols()));
  const Eigen::ArrayXXd lower =
      opening(grid.elevation, static_cast<Eigen::Index>(std::min(half_window, longest)));
  return ((grid.elevation - lower) / (2 * parameters.object_height)).min(1.0);
}

Mask cut(const ElevationGrid& grid, const GraphCutParameters& parameters) {
  const Eigen::ArrayXXd& z = grid.elevation;
  const auto cells = static_cast<std::size_t>(z.size());
  const std::size_t ground = cells, object = cells + 1;  // source and sink
  const Eigen::ArrayXXd ground_costs = groundCosts(grid, parameters);
  Graph graph(cells + 2);
  const auto join = [&](Eigen::Index a, Eigen::Index b) {
    const double step = (z(a) - z(b)) / parameters.step_height;
    const double weight = parameters.smoothness * std::exp(-0.5 * step * step);
    connect(graph, static_cast<std::size_t>(a), static_cast<std::size_t>(b), weight, weight);
  };
  for (Eigen::Index j = 0, cell = 0; j < z.cols(); ++j)
    for (Eigen::Index i = 0; i < z.rows(); ++i, ++cell) {
      if (grid.observed(i, j)) {
        // The cut edge is the cost: a cell on the ground's side is cut from the object's, and pays D(ground).
        connect(graph, ground, static_cast<std::size_t>(cell), 1 - ground_costs(cell), 0);
        connect(graph, static_cast<std::size_t>(cell), object, ground_costs(cell), 0);
      }
      if (i + 1 < z.rows()) join(cell, cell + 1);
      if (j + 1 < z.cols()) join(cell, cell + z.rows());
    }
  boost::boykov_kolmogorov_max_flow(graph, ground, object);

  const auto ground_side = boost::get(boost::vertex_color, graph, ground);
  Mask is_object(z.rows(), z.cols());
  for (std::size_t cell = 0; cell < cells; ++cell)
    is_object(static_cast<Eigen::Index>(cell)) = boost::get(boost::vertex_color, graph, cell) != ground_side;
  return is_object;
}

}  // namespace

Eigen::ArrayXXd opening(const Eigen::ArrayXXd& values, Eigen::Index half_window) {
  return runningExtremes(runningExtremes(values, half_window, std::less<>()), half_window, std::greater<>());
}

GraphCutGround estimateGraphCutGround(const PointsView& points, const Eigen::Isometry3d& frame_from_input,
                                      const GraphCutParameters& parameters) {
  GraphCutGround ground;
  if (points.cols() == 0) return ground;
  const GridGeometry cells = gridAround(boundsOf(points), parameters.cell_size);
  if (static_cast<double>(cells.rows) * static_cast<double>(cells.cols) > MOST_GRAPH_CELLS)
    throw std::length_error("a graph of " + std::to_string(cells.rows) + " x " + std::to_string(cells.cols) +
                            " cells is too large, at most 1e6 are allowed; use larger cells");
  ground.elevation = rasteriseHighest(points, cells);
  ground.is_object = cut(ground.elevation, parameters);
  ground.surface = {frame_from_input, cells, ground.elevation.elevation};
  fillEmptyCells(ground.surface.height, ground.elevation.observed && !ground.is_object);
  return ground;
}

}  // namespace pcl_fft_ground::core
