// The tools of the core that a library has, too, each beside that library's, on what the core asks of them:
// median times, and the ratio of ours to the other (below 1: ours is faster). What is no faster than the
// alternative, nor more exact, has no place in the core.

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <random>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "grid/dct.h"
#include "grid/fft.h"
#include "pcl_fft_ground/core/align/nearest_neighbours.h"
#include "pcl_fft_ground/core/ground/spectrum.h"
#include "scan/radix_sort.h"

namespace {

using namespace pcl_fft_ground::core;
using Complex = std::complex<double>;

double used = 0;  // what comes of the work, so that no compiler leaves it out

/// Median time of a piece of work [us], over at least 15 runs of it and 0.1 s.
double microseconds(const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t LEAST = 15;
  std::vector<double> times;
  double sum = 0;
  while (times.size() < LEAST || sum < 1e5) {
    const auto begin = Clock::now();
    work();
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    sum += times.back();
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

void print(const char* ours, const char* other, const char* unit, long size, double our_time,
           double other_time) {
  std::printf("%-22s %-30s %8ld %-12s %11.1f %11.1f %7.2f\n", ours, other, size, unit, our_time, other_time,
              our_time / other_time);
}

/// The median and the median distance from it, as the scale of the residuals is found, by whole sorting or by
/// selection.
void compareSorting(std::mt19937& random) {
  std::normal_distribution<float> normal;
  for (const std::size_t count : {300U, 3000U, 30000U}) {
    std::vector<float> values(count), copy;
    for (float& value : values) value = normal(random);
    RadixSort sort;
    const double radix = microseconds([&] {
      copy = values;
      sort(copy);
      used += static_cast<double>(copy[count / 2]);
    });
    const double comparisons = microseconds([&] {
      copy = values;
      std::sort(copy.begin(), copy.end());
      used += static_cast<double>(copy[count / 2]);
    });
    // Of sorted values the distances from the median are two sorted halves; selection has to begin anew.
    const double selection = microseconds([&] {
      copy = values;
      const auto middle = copy.begin() + static_cast<std::ptrdiff_t>(count / 2);
      std::nth_element(copy.begin(), middle, copy.end());
      const float median = *middle;
      for (float& value : copy) value = std::abs(value - median);
      std::nth_element(copy.begin(), middle, copy.end());
      used += static_cast<double>(median + *middle);
    });
    print("RadixSort", "std::sort", "values", static_cast<long>(count), radix, comparisons);
    print("RadixSort", "std::nth_element, twice", "values", static_cast<long>(count), radix, selection);
  }
}

/// DCT-II by a Fourier transform of the same length (Makhoul 1980), without the last factors.
class CosineByFourier {
 public:
  explicit CosineByFourier(int length) : shuffled_(length), spectrum_(length), turns_(length) {
    for (int k = 0; k < length; ++k)
      turns_[k] = std::polar(
          1.0F, static_cast<float>(-M_PI) * static_cast<float>(k) / (2 * static_cast<float>(length)));
  }
  void forward(const float* values, float* coefficients) {
    const int length = static_cast<int>(shuffled_.size());
    for (int i = 0; 2 * i < length; ++i) shuffled_[i] = values[2 * i];
    for (int i = 0; 2 * i + 1 < length; ++i) shuffled_[length - 1 - i] = values[2 * i + 1];
    fft_.fwd(spectrum_.data(), shuffled_.data(), length);  // of real numbers: half of the work
    for (int k = 0; k < length; ++k) coefficients[k] = (spectrum_[k] * turns_[k]).real();
  }

 private:
  Eigen::FFT<float> fft_;
  std::vector<float> shuffled_;
  std::vector<std::complex<float>> spectrum_, turns_;
};

void compareCosines(std::mt19937& random) {
  constexpr int LANES = 16;
  std::uniform_real_distribution<float> uniform;
  for (const int length : {60, 240, 512, 960}) {
    using Transform = Dct<float>;
    std::vector<Transform::Lanes, Eigen::aligned_allocator<Transform::Lanes>> lanes(length), scratch(length);
    for (Transform::Lanes& lane : lanes)
      lane = Transform::Lanes::NullaryExpr([&] { return uniform(random); });
    const Transform rotations(length);
    const double ours = microseconds([&] { rotations.forward(lanes.data(), scratch.data()); });
    std::vector<float> line(length, 1.0F), coefficients(length);
    CosineByFourier fourier(length);
    const double others = microseconds([&] {
      for (int n = 0; n < LANES; ++n) fourier.forward(line.data(), coefficients.data());
    });
    used += static_cast<double>(lanes[1][0] + coefficients[1]);
    print("Dct, 16 lines at once", "Eigen::FFT, line by line", "long", length, ours, others);
  }
}

std::vector<Complex> randomLine(int length, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<Complex> line(length);
  for (Complex& value : line) value = {normal(random), normal(random)};
  return line;
}

double timeOfLength(int length, std::mt19937& random) {
  const std::vector<Complex> in = randomLine(length, random);
  std::vector<Complex> out(length);
  Fft fft(length);
  return microseconds([&] { fft.forward(in.data(), out.data()); });
}

void compareFourier(std::mt19937& random) {
  for (const int length : {127, 509, 2003}) {  // primes
    const std::vector<Complex> in = randomLine(length, random);
    std::vector<Complex> out(length);
    Eigen::FFT<double> eigen;
    const double others = microseconds([&] { eigen.fwd(out.data(), in.data(), length); });
    print("Fft (chirp)", "Eigen::FFT as it is", "long", length, timeOfLength(length, random), others);
  }
  for (const int length : {131, 529, 1031}) {
    int power = 1;
    while (power < length) power *= 2;
    print("smoothLength", "next power of two", "long", length, timeOfLength(smoothLength(length), random),
          timeOfLength(power, random));
  }
}

/// The nearest point of a surface to points a little off it, the index built first: a step of ICP.
void compareNeighbours(std::mt19937& random) {
  std::uniform_real_distribution<float> place(0, 4);
  std::normal_distribution<float> noise(0, 0.01F);
  constexpr float SPACING = 0.02F, REACH = 5 * SPACING;
  for (const Eigen::Index count : {4000, 40000}) {
    Points points(3, count), queries(3, count / 4);
    const auto onSurface = [&] {
      const float x = place(random), y = place(random);
      return Eigen::Vector3f(x, y, 0.2F * std::sin(3 * x) * std::cos(2 * y) + noise(random));
    };
    for (Eigen::Index n = 0; n < count; ++n) points.col(n) = onSurface();
    for (Eigen::Index n = 0; n < queries.cols(); ++n) queries.col(n) = onSurface();
    const double columns = microseconds([&] {
      const auto search = columnNeighbours(points, SPACING);
      for (Eigen::Index n = 0; n < queries.cols(); ++n)
        used += static_cast<double>(search->nearest(queries.col(n), REACH).squared_distance);
    });
    const double tree = microseconds([&] {
      const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
      for (Eigen::Index n = 0; n < count; ++n) cloud->emplace_back(points(0, n), points(1, n), points(2, n));
      pcl::KdTreeFLANN<pcl::PointXYZ> search;
      search.setInputCloud(cloud);
      pcl::Indices index(1);
      std::vector<float> distance(1);
      for (Eigen::Index n = 0; n < queries.cols(); ++n) {
        search.nearestKSearch({queries(0, n), queries(1, n), queries(2, n)}, 1, index, distance);
        used += static_cast<double>(distance[0]);
      }
    });
    print("columnNeighbours", "pcl::KdTreeFLANN", "points", static_cast<long>(count), columns, tree);
  }
}

}  // namespace

int main() {
  std::mt19937 random(1);
  std::printf("%-22s %-30s %8s %-12s %11s %11s %7s\n", "ours", "the other", "size", "", "ours [us]",
              "other [us]", "ratio");
  compareSorting(random);
  compareCosines(random);
  compareFourier(random);
  compareNeighbours(random);
  return std::isfinite(used) ? 0 : 1;
}
