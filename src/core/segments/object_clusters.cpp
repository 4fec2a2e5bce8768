#include "pcl_fft_ground/core/segments/object_clusters.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "scan/parameter_check.h"
#include "segments/relief.h"
#include "segments/relief_parts.h"

namespace pcl_fft_ground::core {
namespace {

/** When two touching parts are one body: log-odds, a logistic discriminant of features without a unit.
 *
 * Fitted to all decisions that came up while the parts of simulated wrecks, pipes and reefs (10, 30 and 50 %
 * of objects, seeds 71 to 78) were joined; five more features that were tried (ratio of the areas, share of
 * cliffs, length of the border, step of the tops, number of neighbours) changed nothing.
 */
struct OneBody {
  double always = -0.46;  ///< includes +0.3: a body in two costs more than two bodies in one
  double crease = -1.10;  ///< mean concavity of the border: bodies meet in creases
  double open = 7.77;     ///< share of the border without a crease: two bodies are parted all along
  double hollow = -0.73;  ///< empty area between the two over the smaller one's: a body is nearly convex
  double size = -1.22;    ///< log of the smaller one's area over the smallest object's: small parts are marks
  double growth = -1.10;  ///< by how much the two are wider than the wider one: a body goes on lengthwise
  double length = 0.26;   ///< log of the joint length over width
  double coaxial = 3.38;  ///< the smaller one lies on the axis of the larger, the more the longer that is
  double collar = 3.16;   ///< and is wider or narrower: sockets and necks
  double crossed = -2.26;  ///< coaxial times crease: another body's end lies on the axis, too
};
constexpr OneBody ONE_BODY;

/// Of parts with a border below this, nobody has to ask whether they are one: basins that noise has made.
constexpr double NO_CREASE = 0.15;

/** When two parts of a cluster that need not touch are pieces of one straight body, another one across it.
 * All have to hold; chosen on the same seeds. */
struct Straight {
  double least_part = 0.3;  ///< area of either, of that of the smallest object: less has no direction
  double growth = 0.15;     ///< by how much both are wider than the wider one, at most
  double length = 0.9;      ///< log of the joint length over width, at least: 2.5 times as long as wide
  double width = 0.4;       ///< log of the ratio of the widths, at most
  double turn = 0.03;  ///< of the larger one against the joint axis: sin^2 times log of length over width
  double step = 0.1;   ///< of the height off the larger one's slope, of its width, at most
};
constexpr Straight STRAIGHT;

constexpr double HALF_WIDTH = 1.7320508;  // of a bar, in its standard deviations

double elongation(const SpreadAxes& axes, double most) {
  return std::min(most, std::log(axes.length / axes.width));
}

double deviationAlong(const Part& part, const Eigen::Vector2d& direction) {
  return std::sqrt(part.spread.varianceAlong(direction));
}

Eigen::Vector2d across(const Eigen::Vector2d& axis) {
  return {-axis.y(), axis.x()};
}

SpreadAxes axesOfBoth(const Part& a, const Part& b) {
  Spread both = a.spread;
  both.add(b.spread);
  return axesOf(both);
}

double growthOf(const SpreadAxes& both, const Part& a, const Part& b) {
  return std::clamp(both.width / std::max(a.axes.width, b.axes.width), 0.8, 1.6) - 1;
}

/// Log-odds that two touching parts are one body. \param least area of the smallest object [columns]
double oddsOfOneBody(const Part& larger, const Part& smaller, const Border& border, double least) {
  const double crease = border.crease / border.length;
  const SpreadAxes both = axesOfBoth(larger, smaller);
  const Eigen::Vector2d normal = across(larger.axes.axis);
  const double offset =
      std::abs(normal.dot(smaller.spread.mean() - larger.spread.mean())) / (HALF_WIDTH * larger.axes.width);
  const double coaxial = elongation(larger.axes, 1.5) * std::clamp(1 - offset, 0.0, 1.0);
  const double collar =
      coaxial * std::min(1.0, std::abs(std::log(deviationAlong(smaller, normal) / larger.axes.width)));
  return ONE_BODY.always + ONE_BODY.crease * crease + ONE_BODY.open * border.open / border.length +
         ONE_BODY.hollow * std::clamp(hollowBetween(larger, smaller) / smaller.spread.count, 0.0, 2.0) +
         ONE_BODY.size * std::clamp(std::log(smaller.spread.count / least), -3.0, 2.0) +
         ONE_BODY.growth * growthOf(both, larger, smaller) + ONE_BODY.length * elongation(both, 2) +
         ONE_BODY.coaxial * coaxial + ONE_BODY.collar * collar + ONE_BODY.crossed * coaxial * crease;
}

/// Joins pieces of straight bodies.
class StraightBodies {
 public:
  StraightBodies(const Relief& relief, PartGraph& graph, double least)
      : relief_(relief), graph_(graph), least_(STRAIGHT.least_part * least) {}

  /// As long as pieces are found: one that others cross repeatedly comes together step by step.
  void join() {
    while (joinOnce()) {
    }
  }

 private:
  using Pair = std::pair<std::int32_t, std::int32_t>;

  bool isPiece(std::int32_t part) const {
    return graph_.exists(part) && graph_.part(part).spread.count >= least_;
  }

  /// Parts that touch, and those that touch the same one.
  std::vector<Pair> candidates() const {
    std::vector<Pair> pairs;
    for (std::int32_t middle = 0; middle < static_cast<std::int32_t>(graph_.size()); ++middle) {
      if (!graph_.exists(middle)) continue;
      std::vector<std::int32_t> pieces;
      for (const Border& border : graph_.borders(middle))
        if (isPiece(border.other)) pieces.push_back(border.other);
      for (std::size_t a = 0; a < pieces.size(); ++a) {
        for (std::size_t b = a + 1; b < pieces.size(); ++b) pairs.emplace_back(pieces[a], pieces[b]);
        if (isPiece(middle)) pairs.push_back(std::minmax(middle, pieces[a]));
      }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  bool joinOnce() {
    std::vector<std::tuple<double, std::int32_t, std::int32_t>> fitting;
    for (const auto& [a, b] : candidates()) {
      const double misfit = misfitOf(graph_.part(a), graph_.part(b));
      if (misfit < 1 && isBridged(graph_.part(a), graph_.part(b))) fitting.emplace_back(misfit, a, b);
    }
    std::sort(fitting.begin(), fitting.end());
    std::vector<bool> has_grown(graph_.size(), false);
    for (const auto& [misfit, a, b] : fitting) {
      if (has_grown[static_cast<std::size_t>(a)] || has_grown[static_cast<std::size_t>(b)]) continue;
      has_grown[static_cast<std::size_t>(a)] = has_grown[static_cast<std::size_t>(b)] = true;
      graph_.join(a, b);
    }
    return !fitting.empty();
  }

  /// How far two parts are from being pieces of one straight body: below 1 they are, as far as shapes tell.
  static double misfitOf(const Part& a, const Part& b) {
    constexpr double NEVER = 2;
    const bool a_is_larger = a.spread.count >= b.spread.count;
    const Part& larger = a_is_larger ? a : b;
    const Part& smaller = a_is_larger ? b : a;
    const SpreadAxes both = axesOfBoth(larger, smaller);
    if (elongation(both, 2) < STRAIGHT.length || growthOf(both, larger, smaller) > STRAIGHT.growth)
      return NEVER;
    const Eigen::Vector2d normal = across(both.axis);
    const double width = std::abs(std::log(deviationAlong(larger, normal) / deviationAlong(smaller, normal)));
    const double turn = elongation(larger.axes, 1.5) * (1 - std::pow(larger.axes.axis.dot(both.axis), 2));
    const double way = both.axis.dot(smaller.spread.mean() - larger.spread.mean());
    const double expected = larger.spread.height() + way * larger.spread.slopeAlong(both.axis);
    const double step = std::abs(smaller.spread.height() - expected) /
                        (2 * HALF_WIDTH * std::max(larger.axes.width, smaller.axes.width));
    return std::max({width / STRAIGHT.width, turn / STRAIGHT.turn, step / STRAIGHT.step});
  }

  /// True if the cluster has a column everywhere between the middles of two parts.
  bool isBridged(const Part& a, const Part& b) const {
    const Eigen::Vector2d way = b.spread.mean() - a.spread.mean();
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm())));
    for (int s = 0; s <= steps; ++s) {
      const Eigen::Vector2d place = a.spread.mean() + way * (static_cast<double>(s) / steps);
      if (relief_.at(a.cluster, place.x(), place.y()) == NO_COLUMN) return false;
    }
    return true;
  }

  const Relief& relief_;
  PartGraph& graph_;
  double least_;
};

void validate(const ObjectClusterParameters& parameters) {
  const auto is_length = [](double value) { return std::isfinite(value) && value > 0; };
  constexpr const char* LENGTH = "a finite number of metres above 0";
  require(is_length(parameters.leaf_size), "leaf_size", parameters.leaf_size, LENGTH);
  require(is_length(parameters.minimum_object_size), "minimum_object_size", parameters.minimum_object_size,
          LENGTH);
}

/// Clusters of points by their parts, larger ones first.
std::vector<std::vector<Eigen::Index>> pointsOfParts(const Relief& relief, PartGraph& graph) {
  std::vector<std::int32_t> cluster_of_part(graph.size(), -1);
  std::vector<std::size_t> sizes;
  std::vector<std::int32_t> cluster_of_column(relief.size());
  for (std::size_t c = 0; c < relief.size(); ++c) {
    std::int32_t& cluster = cluster_of_part[static_cast<std::size_t>(graph.partAt(c))];
    if (cluster < 0) {
      cluster = static_cast<std::int32_t>(sizes.size());
      sizes.push_back(0);
    }
    cluster_of_column[c] = cluster;
  }
  for (const ColumnIndex c : relief.columnOfPoint())
    ++sizes[static_cast<std::size_t>(cluster_of_column[static_cast<std::size_t>(c)])];
  std::vector<std::size_t> order(sizes.size()), rank(sizes.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  std::vector<std::vector<Eigen::Index>> clusters(sizes.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = k;
    clusters[k].reserve(sizes[order[k]]);
  }
  for (std::size_t n = 0; n < relief.columnOfPoint().size(); ++n) {
    const auto c = static_cast<std::size_t>(relief.columnOfPoint()[n]);
    clusters[rank[static_cast<std::size_t>(cluster_of_column[c])]].push_back(static_cast<Eigen::Index>(n));
  }
  return clusters;
}

}  // namespace

std::vector<std::vector<Eigen::Index>> objectClusters(const PointsView& points,
                                                      const ObjectClusterParameters& parameters) {
  validate(parameters);
  const Relief relief(points, parameters.leaf_size);
  const double least = std::pow(parameters.minimum_object_size / relief.side(), 2);
  const std::vector<float> concave = concavity(relief, smoothed(relief, relief.heights()));

  PartGraph graph(relief, basins(relief, smoothed(relief, smoothed(relief, concave))), concave);
  graph.joinUpTo(NO_CREASE, [&](const Part&, const Part& smaller, const Border& border) {
    return border.crease / border.length * std::sqrt(std::min(1.0, smaller.spread.count / least));
  });
  graph.outline(relief);
  graph.joinUpTo(0, [&](const Part& larger, const Part& smaller, const Border& border) {
    return -oddsOfOneBody(larger, smaller, border, least);
  });
  StraightBodies(relief, graph, least).join();
  // What is still smaller than the smallest object is a mark of what it touches.
  constexpr double NEVER = 1e6;
  graph.joinUpTo(NEVER, [&](const Part& larger, const Part& smaller, const Border& border) {
    return smaller.spread.count < least ? -oddsOfOneBody(larger, smaller, border, least) : NEVER;
  });
  return pointsOfParts(relief, graph);
}

}  // namespace pcl_fft_ground::core
