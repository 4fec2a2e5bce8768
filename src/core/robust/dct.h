#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_fft_ground::core {

/** Orthonormal cosine transform (DCT-II) of real lines of one length, and its inverse (DCT-III).
 *
 * Coefficient k of a line x is c_k sum_i x_i cos(pi (2 i + 1) k / (2 N)), c_0 = sqrt(1 / N), c_k = sqrt(2 /
 * N): the line continues evenly beyond its ends, without wrap-around. Even lengths are halved again and
 * again (Lee 1984), the rest m is summed up: O(N (m + log N)). Several lines go through side by side.
 * An object holds its scratch space: one per thread.
 */
class Dct {
 public:
  /// A value of each of the lines that are transformed together.
  using Lanes = Eigen::Array<double, 8, 1>;

  explicit Dct(Eigen::Index length);

  Eigen::Index length() const { return length_; }

  /// Transforms lines in place: `values` are their first values, their second ones and so on.
  void forward(Lanes* values);

  /// Undoes forward().
  void inverse(Lanes* values);

 private:
  void transform(Lanes* values, Lanes* scratch, Eigen::Index length) const;
  void transposed(Lanes* values, Lanes* scratch, Eigen::Index length) const;

  Eigen::Index length_, base_;   // base_: what is left of the length after halving
  std::vector<double> scales_;   // c_k
  std::vector<double> secants_;  // 1 / (2 cos(pi (2 i + 1) / (2 n))) at n / 2 + i, for every halved n
  Eigen::ArrayXXd cosines_;      // (k, i) of the base
  std::vector<Lanes> scratch_;
};

/// Orthonormal cosine transform of grids of one size, in place.
class Dct2d {
 public:
  Dct2d(Eigen::Index rows, Eigen::Index cols);

  /// Coefficient (k, l) belongs to k half waves along the rows and l along the columns.
  void forward(Eigen::ArrayXXd& grid);

  /// Undoes forward().
  void inverse(Eigen::ArrayXXd& coefficients);

 private:
  using Transform = void (Dct::*)(Dct::Lanes*);

  void eachColumn(Eigen::ArrayXXd& grid, Transform transform);
  void eachRow(Eigen::ArrayXXd& grid, Transform transform);

  Dct along_rows_, along_cols_;
  std::vector<Dct::Lanes> lines_;
};

/// The smallest length from `length` on that is transformed fast: its odd factor is 15 at the most.
Eigen::Index fastDctLength(Eigen::Index length);

}  // namespace pcl_fft_ground::core
