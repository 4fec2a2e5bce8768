#include "pcl_fft_ground/core/scan/point_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "pcl_fft_ground/core/scan/threads.h"
#include "scan/in_parts.h"

namespace pcl_fft_ground::core {
namespace {

/// As many bits as let n products of two such numbers be summed in 63 bits, and no more than 20: a millionth.
int quantisationBits(Eigen::Index n) {
  return std::clamp((62 - std::ilogb(static_cast<double>(n))) / 2, 1, 20);
}

/// Sums of coordinates that are whole numbers, and of their products: x, y, z, xx, xy, xz, yy, yz, zz.
template <typename Number>
struct Moments {
  std::array<Number, 9> sums;

  Moments() { sums.fill(Number(0)); }
  void add(const Number& x, const Number& y, const Number& z) {
    sums[0] += x, sums[1] += y, sums[2] += z;
    sums[3] += x * x, sums[4] += x * y, sums[5] += x * z;
    sums[6] += y * y, sums[7] += y * z, sums[8] += z * z;
  }
  void add(const Moments& other) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += other.sums[k];
  }
};

using IntegerMoments = Moments<std::int64_t>;
using Sums = Eigen::Matrix<std::int64_t, 9, 1>;
/// Of two points at a time in double, which is exact up to 2^53.
struct PairMoments : Moments<Eigen::Array2d> {
  void addTo(IntegerMoments& total) const {
    for (std::size_t k = 0; k < sums.size(); ++k) total.sums[k] += static_cast<std::int64_t>(sums[k].sum());
  }
};

Eigen::Vector3d meanOf(const IntegerMoments& moments, double n) {
  return Eigen::Map<const Sums>(moments.sums.data()).head<3>().cast<double>() / n;
}

Eigen::Matrix3d covarianceOf(const IntegerMoments& moments, double n) {
  const Eigen::Matrix<double, 9, 1> s = Eigen::Map<const Sums>(moments.sums.data()).cast<double>();
  const Eigen::Vector3d mean = meanOf(moments, n);
  Eigen::Matrix3d products;
  products << s[3], s[4], s[5], s[4], s[6], s[7], s[5], s[7], s[8];
  return products / n - mean * mean.transpose();
}

/// Four points at a time fill whole vector registers.
using FourPoints = Eigen::Array<float, 12, 1>;

FourPoints fourTimes(const Eigen::Array3f& values) {
  return values.replicate<4, 1>();
}

FourPoints fourPointsAt(const PointsView& points, Eigen::Index i) {
  return Eigen::Map<const FourPoints>(points.data() + 3 * i);
}

/// Moments of the points counted in steps from the lower corner.
IntegerMoments integerMoments(const PointsView& points, const Eigen::Array3d& low, float steps_per_metre) {
  constexpr Eigen::Index BLOCK = 8192;  // two sums of 4096 products below 2^40: far from 2^53
  IntegerMoments moments;
  const FourPoints lows = fourTimes(low.cast<float>());
  const Eigen::Index fours = points.cols() / 4 * 4;
  for (Eigen::Index begin = 0; begin < fours; begin += BLOCK) {
    PairMoments pairs;
    for (Eigen::Index i = begin; i < std::min(begin + BLOCK, fours); i += 4) {
      const Eigen::Array<int, 12, 1> q = ((fourPointsAt(points, i) - lows) * steps_per_metre).cast<int>();
      pairs.add({q[0], q[3]}, {q[1], q[4]}, {q[2], q[5]});
      pairs.add({q[6], q[9]}, {q[7], q[10]}, {q[8], q[11]});
    }
    pairs.addTo(moments);
  }
  for (Eigen::Index i = fours; i < points.cols(); ++i) {
    const Eigen::Array3i q = ((points.col(i).array() - lows.head<3>()) * steps_per_metre).cast<int>();
    moments.add(q[0], q[1], q[2]);
  }
  return moments;
}

/// Of at least one point.
Bounds boundsOfPart(const PointsView& points) {
  FourPoints lows = fourTimes(points.col(0)), highs = lows;
  const Eigen::Index fours = points.cols() / 4 * 4;
  for (Eigen::Index i = 0; i < fours; i += 4) {
    const FourPoints p = fourPointsAt(points, i);
    lows = lows.min(p);
    highs = highs.max(p);
  }
  Eigen::Array3f low = lows.reshaped(3, 4).rowwise().minCoeff(),
                 high = highs.reshaped(3, 4).rowwise().maxCoeff();
  for (Eigen::Index i = fours; i < points.cols(); ++i) {
    low = low.min(points.col(i).array());
    high = high.max(points.col(i).array());
  }
  return {low.cast<double>(), high.cast<double>()};
}

}  // namespace

Bounds boundsOf(const PointsView& points) {
  if (points.cols() == 0) return {};
  const std::vector<Bounds> parts =
      resultsOfRanges(points.cols(), POINTS_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
        return boundsOfPart(points.middleCols(begin, end - begin));
      });
  Bounds all = parts.front();
  for (const Bounds& part : parts) {
    all.low = all.low.min(part.low);
    all.high = all.high.max(part.high);
  }
  return all;
}

double wholeOrigin(std::vector<double> coordinates) {
  const auto finite_end = std::remove_if(coordinates.begin(), coordinates.end(),
                                         [](double value) { return !std::isfinite(value); });
  if (finite_end == coordinates.begin()) return 0;
  const auto middle = coordinates.begin() + (finite_end - coordinates.begin()) / 2;
  std::nth_element(coordinates.begin(), middle, finite_end);
  return std::abs(*middle) > LARGE_COORDINATE ? std::round(*middle) : 0;
}

MomentsInParts::MomentsInParts(const Bounds& bounds, Eigen::Index points) : points_(points), bounds_(bounds) {
  const double extent = (bounds.high - bounds.low).maxCoeff();
  constexpr double LEAST = 1e-32;  // below it float does not hold the steps: all points are in one place then
  if (extent > LEAST) steps_ = std::ldexp(1.0, quantisationBits(points)) / extent;
}

void MomentsInParts::add(const PointsView& part) {
  if (steps_ == 0) return;
  // Between the ends of float the differences are beyond it: halves are not.
  const bool is_too_wide = (bounds_.high - bounds_.low).maxCoeff() > std::numeric_limits<float>::max();
  const IntegerMoments moments =
      is_too_wide ? integerMoments(0.5F * part, 0.5 * bounds_.low, static_cast<float>(2 * steps_))
                  : integerMoments(part, bounds_.low, static_cast<float>(steps_));
  for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += moments.sums[k];
}

PointStatistics MomentsInParts::statistics() const {
  PointStatistics result;
  result.bounds = bounds_;
  result.mean = bounds_.low;
  if (steps_ == 0) return result;
  IntegerMoments moments;
  moments.sums = sums_;
  const auto n = static_cast<double>(points_);
  // The casts round down: half a step brings the mean back to the middle.
  result.mean = bounds_.low + (meanOf(moments, n).array() + 0.5) / steps_;
  result.covariance = covarianceOf(moments, n) / (steps_ * steps_);
  return result;
}

PointStatistics summarise(const PointsView& points) {
  MomentsInParts moments(boundsOf(points), points.cols());
  moments.add(points);
  return moments.statistics();
}

}  // namespace pcl_fft_ground::core
