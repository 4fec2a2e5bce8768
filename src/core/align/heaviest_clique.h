#pragma once

#include <cstddef>
#include <vector>

namespace pcl_fft_ground::core {

/// Which vertices of an undirected graph are joined; symmetric, nothing is joined to itself.
using Adjacency = std::vector<std::vector<bool>>;

/** Vertices that are all joined to each other and weigh most together, ascending.
 *
 * Branch and bound with a greedy colouring as the bound. After a great many branches the best clique so far
 * is returned; it is the same at every call.
 *
 * \param weights one per vertex, > 0
 */
std::vector<std::size_t> heaviestClique(const std::vector<double>& weights, const Adjacency& joined);

}  // namespace pcl_fft_ground::core
