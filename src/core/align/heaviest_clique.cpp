#include "align/segment_matching.h"

#include <algorithm>
#include <numeric>

namespace pcl_fft_ground::core {
namespace {

using Vertices = std::vector<std::size_t>;

class CliqueSearch {
 public:
  CliqueSearch(const std::vector<double>& weights, const Adjacency& joined)
      : weights_(weights), joined_(joined) {}

  Vertices run() {
    Vertices all(weights_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::stable_sort(all.begin(), all.end(),
                     [this](std::size_t a, std::size_t b) { return weights_[a] > weights_[b]; });
    extend(all);
    std::sort(best_.begin(), best_.end());
    return best_;
  }

 private:
  /// Vertices by colour, no two of a colour joined, and what a clique of all up to each can weigh at most.
  struct Coloured {
    Vertices vertices;
    std::vector<double> bounds;
  };

  bool fits(const Vertices& colour, std::size_t vertex) const {
    return std::none_of(colour.begin(), colour.end(),
                        [&](std::size_t other) { return joined_[vertex][other]; });
  }

  Coloured colour(const Vertices& candidates) const {
    std::vector<Vertices> colours;
    for (const std::size_t vertex : candidates) {
      const auto place = std::find_if(colours.begin(), colours.end(),
                                      [&](const Vertices& colour) { return fits(colour, vertex); });
      if (place == colours.end())
        colours.push_back({vertex});
      else
        place->push_back(vertex);
    }
    Coloured result;
    double bound = 0;
    for (const Vertices& colour : colours) {
      bound += weights_[colour.front()];  // the heaviest of its colour, as candidates come sorted
      result.vertices.insert(result.vertices.end(), colour.begin(), colour.end());
      result.bounds.resize(result.vertices.size(), bound);
    }
    return result;
  }

  void extend(const Vertices& candidates) {
    if (weight_ > best_weight_) {
      best_weight_ = weight_;
      best_ = clique_;
    }
    const Coloured coloured = colour(candidates);
    Vertices left = candidates;
    for (std::size_t n = coloured.vertices.size(); n-- > 0;) {
      if (weight_ + coloured.bounds[n] <= best_weight_ || ++branches_ > MAX_BRANCHES) return;
      const std::size_t vertex = coloured.vertices[n];
      left.erase(std::find(left.begin(), left.end(), vertex));
      Vertices neighbours;
      std::copy_if(left.begin(), left.end(), std::back_inserter(neighbours),
                   [&](std::size_t other) { return joined_[vertex][other]; });
      clique_.push_back(vertex);
      weight_ += weights_[vertex];
      extend(neighbours);
      weight_ -= weights_[vertex];
      clique_.pop_back();
    }
  }

  static constexpr std::size_t MAX_BRANCHES = 20000;

  const std::vector<double>& weights_;
  const Adjacency& joined_;
  Vertices clique_;
  Vertices best_;
  double weight_ = 0;
  double best_weight_ = 0;
  std::size_t branches_ = 0;
};

}  // namespace

std::vector<std::size_t> heaviestClique(const std::vector<double>& weights, const Adjacency& joined) {
  return CliqueSearch(weights, joined).run();
}

}  // namespace pcl_fft_ground::core
