#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_fft_ground::core {

/** Orthonormal cosine transform (DCT-II) of lines of one length, in place, and its inverse.
 *
 * Coefficient k is c_k sum_i values_i cos(pi (2 i + 1) k / (2 N)), c_0 = sqrt(1 / N), c_k = sqrt(2 /
 * N): the line continues evenly beyond its ends, without wrap-around. Even lengths are halved again and
 * again by rotations (Plonka and Tasche 2005), which keep the precision whatever the length; the rest m is
 * summed up: O(N (m + log N)). Several lines go through side by side.
 */
template <typename Number>
class Dct {
 public:
  /// A value of each of the lines that are transformed together.
  using Lanes = Eigen::Array<Number, 16, 1>;

  explicit Dct(Eigen::Index length);

  Eigen::Index length() const { return length_; }

  /// Transforms lines in place: `values` are their first values, their second ones and so on.
  /// \param scratch as long as the values
  void forward(Lanes* values, Lanes* scratch) const;

  /// Undoes forward().
  void inverse(Lanes* values, Lanes* scratch) const;

 private:
  using Line = Eigen::Array<Number, Eigen::Dynamic, 1>;

  // Without the factors c_k; `scratch` is as long as the values.
  void second(Lanes* values, Lanes* scratch, Eigen::Index length) const;
  void secondTransposed(Lanes* values, Lanes* scratch, Eigen::Index length) const;
  void fourth(Lanes* values, Lanes* scratch, Eigen::Index length) const;
  void secondOfBase(Lanes* values, Lanes* scratch) const;
  void secondOfBaseTransposed(Lanes* values, Lanes* scratch) const;
  void fourthOfBase(Lanes* values, Lanes* scratch) const;

  Eigen::Index length_, base_;  // base_: what is left of the length after halving
  Line scales_;                 // c_k
  Line cosines_, sines_;        // of pi (2 i + 1) / (4 n), at n / 2 + i, for every halved n
  Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic> second_, fourth_;  // (i, k) of the base
};

/// Orthonormal cosine transform of grids of one size, in place.
template <typename Number>
class Dct2d {
 public:
  using Grid = Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic>;

  Dct2d(Eigen::Index rows, Eigen::Index cols);

  /// Coefficient (k, l) belongs to k half waves along the rows and l along the columns.
  void forward(Grid& grid) const;

  /// Undoes forward().
  void inverse(Grid& coefficients) const;

 private:
  using Lanes = typename Dct<Number>::Lanes;
  using Transform = void (Dct<Number>::*)(Lanes*, Lanes*) const;

  void eachColumn(Grid& grid, Transform transform) const;
  void eachRow(Grid& grid, Transform transform) const;
  template <int LinesAtCompileTime, typename Lines>
  static void apply(const Dct<Number>& dct, Transform transform, std::vector<Lanes>& scratch, Lines&& lines);

  Dct<Number> along_rows_, along_cols_;
};

/// The smallest length from `length` on that is transformed fast: its odd factor is 15 at the most.
Eigen::Index fastDctLength(Eigen::Index length);

}  // namespace pcl_fft_ground::core
