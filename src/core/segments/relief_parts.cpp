#include "segments/relief_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "pcl_fft_ground/core/scan/convex_hull.h"

namespace pcl_fft_ground::core {
namespace {

// The concavity of a border [1 / column] counts from CONVEX, which one ridge more or less does not change, to
// STEP, beyond which a step is as good as a cliff. Below OPEN it is what noise and a curved body make.
constexpr float CONVEX = -0.3F, STEP = 1.5F, OPEN = 0.15F;

constexpr double COLUMN_VARIANCE = 1.0 / 12;  // of a square of side 1

double areaOf(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Eigen::Vector2d& a = polygon[n];
    const Eigen::Vector2d& b = polygon[n + 1 == polygon.size() ? 0 : n + 1];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

std::vector<Eigen::Vector2d> hullAround(const Part& a, const Part& b) {
  std::vector<Eigen::Vector2d> corners = a.hull;
  corners.insert(corners.end(), b.hull.begin(), b.hull.end());
  return convexHull(std::move(corners));
}

std::vector<Border>::iterator place(std::vector<Border>& borders, std::int32_t other) {
  return std::lower_bound(borders.begin(), borders.end(), other,
                          [](const Border& border, std::int32_t number) { return border.other < number; });
}

void addBorder(std::vector<Border>& borders, const Border& border) {
  const auto found = place(borders, border.other);
  if (found != borders.end() && found->other == border.other)
    found->add(border);
  else
    borders.insert(found, border);
}

void removeBorder(std::vector<Border>& borders, std::int32_t other) {
  const auto found = place(borders, other);
  if (found != borders.end() && found->other == other) borders.erase(found);
}

/// Both sorted lists in one, without the two parts themselves.
std::vector<Border> united(const std::vector<Border>& a, const std::vector<Border>& b, std::int32_t own_a,
                           std::int32_t own_b) {
  std::vector<Border> result;
  result.reserve(a.size() + b.size());
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() || j != b.end()) {
    const bool from_a = j == b.end() || (i != a.end() && i->other <= j->other);
    const bool from_b = i == a.end() || (j != b.end() && j->other <= i->other);
    Border border = from_a ? *i : *j;
    if (from_a && from_b) border.add(*j);
    if (from_a) ++i;
    if (from_b) ++j;
    if (border.other != own_a && border.other != own_b) result.push_back(border);
  }
  return result;
}

}  // namespace

void Spread::add(double at_x, double at_y, double height) {
  count += 1;
  x += at_x;
  y += at_y;
  xx += at_x * at_x;
  xy += at_x * at_y;
  yy += at_y * at_y;
  z += height;
  xz += at_x * height;
  yz += at_y * height;
}

void Spread::add(const Spread& other) {
  count += other.count;
  x += other.x;
  y += other.y;
  xx += other.xx;
  xy += other.xy;
  yy += other.yy;
  z += other.z;
  xz += other.xz;
  yz += other.yz;
}

double Spread::varianceAlong(const Eigen::Vector2d& direction) const {
  const Eigen::Vector2d m = mean();
  const double vxx = xx / count - m.x() * m.x(), vxy = xy / count - m.x() * m.y(),
               vyy = yy / count - m.y() * m.y();
  return direction.x() * direction.x() * vxx + 2 * direction.x() * direction.y() * vxy +
         direction.y() * direction.y() * vyy + COLUMN_VARIANCE;
}

double Spread::slopeAlong(const Eigen::Vector2d& direction) const {
  const Eigen::Vector2d m = mean();
  const Eigen::Vector2d with_height(xz / count - m.x() * height(), yz / count - m.y() * height());
  return direction.dot(with_height) / varianceAlong(direction);
}

SpreadAxes axesOf(const Spread& spread) {
  const double vxx = spread.varianceAlong(Eigen::Vector2d::UnitX());
  const double vyy = spread.varianceAlong(Eigen::Vector2d::UnitY());
  const double vxy = spread.xy / spread.count - spread.mean().x() * spread.mean().y();
  const double middle = 0.5 * (vxx + vyy), half = 0.5 * (vxx - vyy), radius = std::hypot(half, vxy);
  const double angle = 0.5 * std::atan2(vxy, half);
  return {std::sqrt(middle + radius),
          std::sqrt(std::max(COLUMN_VARIANCE, middle - radius)),
          {std::cos(angle), std::sin(angle)}};
}

void Border::add(const Border& more) {
  length += more.length;
  crease += more.crease;
  open += more.open;
}

double hollowBetween(const Part& a, const Part& b) {
  const double hollow = areaOf(hullAround(a, b)) - a.spread.count - b.spread.count;
  return hollow - a.hollow - b.hollow;
}

PartGraph::PartGraph(const Relief& relief, std::vector<std::int32_t> part, const std::vector<float>& concave)
    : part_of_column_(std::move(part)) {
  const std::int32_t count =
      part_of_column_.empty() ? 0 : 1 + *std::max_element(part_of_column_.begin(), part_of_column_.end());
  parts_.resize(static_cast<std::size_t>(count));
  borders_.resize(parts_.size());
  version_.resize(parts_.size(), 0);
  owner_.resize(parts_.size());
  std::iota(owner_.begin(), owner_.end(), 0);
  for (std::size_t c = 0; c < part_of_column_.size(); ++c) {
    Part& own = parts_[static_cast<std::size_t>(part_of_column_[c])];
    own.spread.add(relief.x(c), relief.y(c), relief.heights()[c]);
    own.cluster = relief.cluster(c);
    for (std::size_t d = 0; d < 4; ++d) {
      const ColumnIndex neighbour = relief.neighbours(c)[d];
      if (neighbour == NO_COLUMN) continue;
      const std::int32_t a = part_of_column_[c], b = part_of_column_[static_cast<std::size_t>(neighbour)];
      if (a == b) continue;
      const float bend = std::max(concave[c], concave[static_cast<std::size_t>(neighbour)]);
      const double length = d % 2 == 0 ? 1 : 0.5 * std::sqrt(2.0);
      Border border{b, length, length * std::clamp(bend, CONVEX, STEP), bend < OPEN ? length : 0};
      addBorder(borders_[static_cast<std::size_t>(a)], border);
      border.other = a;
      addBorder(borders_[static_cast<std::size_t>(b)], border);
    }
  }
  for (Part& own : parts_) own.axes = axesOf(own.spread);
}

std::int32_t PartGraph::find(std::int32_t part) {
  std::int32_t* owner = owner_.data();
  while (owner[part] != part) part = owner[part] = owner[owner[part]];
  return part;
}

std::int32_t PartGraph::partAt(std::size_t column) {
  return find(part_of_column_[column]);
}

std::int32_t PartGraph::join(std::int32_t a, std::int32_t b) {
  const auto degree = [&](std::int32_t part) { return borders(part).size(); };
  if (degree(a) < degree(b) || (degree(a) == degree(b) && b < a)) std::swap(a, b);
  const auto kept = static_cast<std::size_t>(a), taken = static_cast<std::size_t>(b);
  Part& part = parts_[kept];
  part.spread.add(parts_[taken].spread);
  part.axes = axesOf(part.spread);
  if (outlined_) {
    part.hull = hullAround(part, parts_[taken]);
    part.hollow = areaOf(part.hull) - part.spread.count;
  }
  owner_[taken] = a;
  ++version_[kept];
  for (Border border : borders_[taken]) {
    std::vector<Border>& others = borders_[static_cast<std::size_t>(border.other)];
    removeBorder(others, b);
    if (border.other == a) continue;
    border.other = a;
    addBorder(others, border);
  }
  borders_[kept] = united(borders_[kept], borders_[taken], a, b);
  borders_[taken].clear();
  return a;
}

double PartGraph::costOf(std::int32_t a, const Border& border, const Cost& cost) const {
  const Part& one = part(a);
  const Part& other = part(border.other);
  const bool is_larger =
      one.spread.count > other.spread.count || (one.spread.count == other.spread.count && a < border.other);
  return is_larger ? cost(one, other, border) : cost(other, one, border);
}

void PartGraph::joinUpTo(double limit, const Cost& cost) {
  using Offer = std::tuple<double, std::int32_t, std::int32_t, std::uint32_t>;  // the last: versions, added
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
  const auto versions = [&](std::int32_t a, std::int32_t b) {
    return version_[static_cast<std::size_t>(a)] + version_[static_cast<std::size_t>(b)];
  };
  const auto offer = [&](std::int32_t a, const Border& border) {
    const double price = costOf(a, border, cost);
    if (price < limit)
      offers.emplace(price, std::min(a, border.other), std::max(a, border.other), versions(a, border.other));
  };
  for (std::size_t a = 0; a < size(); ++a)
    for (const Border& border : borders_[a])
      if (static_cast<std::int32_t>(a) < border.other) offer(static_cast<std::int32_t>(a), border);
  while (!offers.empty()) {
    const auto [price, a, b, version] = offers.top();
    offers.pop();
    if (!exists(a) || !exists(b) || versions(a, b) != version) continue;
    const std::int32_t joined = join(a, b);
    for (const Border& border : borders(joined)) offer(joined, border);
  }
}

void PartGraph::outline(const Relief& relief) {
  std::vector<std::vector<Eigen::Vector2d>> corners(parts_.size());
  for (std::size_t c = 0; c < part_of_column_.size(); ++c) {
    const std::int32_t own = partAt(c);
    bool is_inner = true;
    for (std::size_t d = 0; d < 8; d += 2) {
      const ColumnIndex neighbour = relief.neighbours(c)[d];
      is_inner = is_inner && neighbour != NO_COLUMN && partAt(static_cast<std::size_t>(neighbour)) == own;
    }
    if (is_inner) continue;
    for (const double dx : {-0.5, 0.5})
      for (const double dy : {-0.5, 0.5})
        corners[static_cast<std::size_t>(own)].emplace_back(relief.x(c) + dx, relief.y(c) + dy);
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    if (!exists(static_cast<std::int32_t>(p))) continue;
    parts_[p].hull = convexHull(std::move(corners[p]));
    parts_[p].hollow = areaOf(parts_[p].hull) - parts_[p].spread.count;
  }
  outlined_ = true;
}

}  // namespace pcl_fft_ground::core
