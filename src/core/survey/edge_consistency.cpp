#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "align/rigid_motion.h"
#include "pcl_fft_ground/core/survey/pose_graph.h"

namespace pcl_fft_ground::core {
namespace {

constexpr std::size_t LONGEST = 4;  // edges of a cycle: lawn-mower transects have squares, overlaps triangles

/// Some edges that lead from a node back to it.
struct Cycle {
  std::array<std::size_t, LONGEST> edges;
  std::size_t length;
  bool is_closed;  ///< whether they contradict each other by no more than their covariances let expect
};

/// How a node is left by an edge.
struct Step {
  std::size_t edge, to;
};

/// The edges walked one after the other: where they lead, and the covariance of that, a motion after it.
class Walk {
 public:
  explicit Walk(const std::vector<PoseGraphEdge>& edges) : edges_(edges) {}

  void take(std::size_t from, std::size_t number) {
    const PoseGraphEdge& edge = edges_[number];
    const bool is_forth = edge.reference == from;
    const Eigen::Isometry3d step =
        is_forth ? edge.reference_from_moving : edge.reference_from_moving.inverse();
    const Matrix6d carried = adjoint(is_forth ? start_from_here_ : start_from_here_ * step);
    covariance_ += carried * edge.covariance * carried.transpose();
    start_from_here_ = start_from_here_ * step;
  }

  /// By how many standard deviations the walk does not end where it began, squared.
  double squaredDeviation() const {
    const Vector6d error = twistOf(start_from_here_);
    return error.dot(covariance_.llt().solve(error));
  }

 private:
  const std::vector<PoseGraphEdge>& edges_;
  Eigen::Isometry3d start_from_here_ = Eigen::Isometry3d::Identity();
  Matrix6d covariance_ = Matrix6d::Zero();
};

/// Finds the cycles of two to LONGEST edges, each once.
class CycleFinder {
 public:
  CycleFinder(const std::vector<PoseGraphEdge>& edges, double deviation)
      : edges_(edges), squared_deviation_(deviation * deviation) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      steps_[edges[e].reference].push_back({e, edges[e].moving});
      steps_[edges[e].moving].push_back({e, edges[e].reference});
    }
  }

  std::vector<Cycle> cycles() {
    for (const auto& [node, steps] : steps_) extend(node, node, 0);
    return found_;
  }

 private:
  /// \param first node at which the walk began: the least of the cycle
  void extend(std::size_t first, std::size_t here, std::size_t length) {
    for (const Step& step : steps_.at(here)) {
      const auto walked = path_.begin() + static_cast<std::ptrdiff_t>(length);
      if (std::find(path_.begin(), walked, step.edge) != walked || step.to < first) continue;
      path_[length] = step.edge;
      if (step.to == first) {
        // Of its two directions the one that begins with the lesser edge.
        if (length > 0 && path_[0] < step.edge) add(first, length + 1);
      } else if (length + 1 < LONGEST && !wasVisited(first, step.to, length)) {
        extend(first, step.to, length + 1);
      }
    }
  }

  bool wasVisited(std::size_t first, std::size_t node, std::size_t length) const {
    std::size_t here = first;
    for (std::size_t k = 0; k < length; ++k) {
      here = edges_[path_[k]].reference == here ? edges_[path_[k]].moving : edges_[path_[k]].reference;
      if (here == node) return true;
    }
    return false;
  }

  void add(std::size_t first, std::size_t length) {
    Walk walk(edges_);
    std::size_t here = first;
    for (std::size_t k = 0; k < length; ++k) {
      walk.take(here, path_[k]);
      here = edges_[path_[k]].reference == here ? edges_[path_[k]].moving : edges_[path_[k]].reference;
    }
    const double allowed = squared_deviation_ * static_cast<double>(length);
    found_.push_back({path_, length, walk.squaredDeviation() <= allowed});
  }

  const std::vector<PoseGraphEdge>& edges_;
  double squared_deviation_;
  std::map<std::size_t, std::vector<Step>> steps_;  // by node
  std::array<std::size_t, LONGEST> path_{};
  std::vector<Cycle> found_;
};

/// How many cycles of an edge are closed and open.
struct Votes {
  double closed = 0, open = 0;

  /// Share of the edge's cycles that do not close.
  double against() const { return open > 0 ? open / (open + closed) : 0; }
};

/// For each edge the cycles in which all other edges are kept.
std::vector<Votes> votesOf(const std::vector<Cycle>& cycles, const std::vector<bool>& is_kept) {
  std::vector<Votes> votes(is_kept.size());
  for (const Cycle& cycle : cycles) {
    const auto end = cycle.edges.begin() + static_cast<std::ptrdiff_t>(cycle.length);
    const auto left_out = [&](std::size_t edge) { return !is_kept[edge]; };
    const auto missing = std::count_if(cycle.edges.begin(), end, left_out);
    if (missing > 1) continue;
    const auto only = std::find_if(cycle.edges.begin(), end, left_out);
    for (auto edge = missing == 1 ? only : cycle.edges.begin(); edge != (missing == 1 ? only + 1 : end);
         ++edge)
      ++(cycle.is_closed ? votes[*edge].closed : votes[*edge].open);
  }
  return votes;
}

/// The edge that most of its cycles speak against, of those kept, if any does.
std::optional<std::size_t> mostContradicted(const std::vector<Votes>& votes,
                                            const std::vector<bool>& is_kept) {
  std::optional<std::size_t> worst;
  const auto rank = [&](std::size_t edge) { return std::pair(votes[edge].against(), votes[edge].open); };
  for (std::size_t edge = 0; edge < votes.size(); ++edge)
    if (is_kept[edge] && votes[edge].open > 0 && (!worst || rank(edge) > rank(*worst))) worst = edge;
  return worst;
}

/// Of the edges left out that which contradicts none of those kept and agrees with most, if there is one.
std::optional<std::size_t> mostWelcome(const std::vector<Votes>& votes, const std::vector<bool>& is_kept) {
  std::optional<std::size_t> best;
  for (std::size_t edge = 0; edge < votes.size(); ++edge)
    if (!is_kept[edge] && !(votes[edge].open > 0) && (!best || votes[edge].closed > votes[*best].closed))
      best = edge;
  return best;
}

}  // namespace

std::vector<bool> consistentEdges(const std::vector<PoseGraphEdge>& edges, double outlier_deviation) {
  const std::vector<Cycle> cycles = CycleFinder(edges, outlier_deviation).cycles();
  std::vector<bool> is_kept(edges.size(), true);
  while (const std::optional<std::size_t> worst = mostContradicted(votesOf(cycles, is_kept), is_kept))
    is_kept[*worst] = false;
  while (const std::optional<std::size_t> back = mostWelcome(votesOf(cycles, is_kept), is_kept))
    is_kept[*back] = true;
  return is_kept;
}

}  // namespace pcl_fft_ground::core
