#include <algorithm>

#include "grid/dct.h"

namespace pcl_fft_ground::core {

template <typename Number>
Dct2d<Number>::Dct2d(Eigen::Index rows, Eigen::Index cols)
    : along_rows_(rows),
      along_cols_(cols),
      lines_(static_cast<std::size_t>(std::max(rows, cols)), Lanes::Zero()) {}

/// Transforms lines that are the rows of a block; a number of them known to the compiler is copied faster.
template <typename Number>
template <int LinesAtCompileTime, typename Lines>
void Dct2d<Number>::apply(Dct<Number>& dct, Transform transform, Lines&& lines) {
  Eigen::Map<Eigen::Array<Number, Lanes::SizeAtCompileTime, Eigen::Dynamic>> all(
      lines_.data()->data(), Lanes::SizeAtCompileTime, dct.length());
  auto own = all.template topRows<LinesAtCompileTime>(lines.rows());
  own = lines;
  (dct.*transform)(lines_.data());
  lines = own;
}

template <typename Number>
void Dct2d<Number>::eachColumn(Grid& grid, Transform transform) {
  constexpr int LANES = Lanes::SizeAtCompileTime;
  Eigen::Index j = 0;
  for (; j + LANES <= grid.cols(); j += LANES)
    apply<LANES>(along_rows_, transform, grid.template middleCols<LANES>(j).transpose());
  if (j < grid.cols())
    apply<Eigen::Dynamic>(along_rows_, transform, grid.rightCols(grid.cols() - j).transpose());
}

template <typename Number>
void Dct2d<Number>::eachRow(Grid& grid, Transform transform) {
  constexpr int LANES = Lanes::SizeAtCompileTime;
  Eigen::Index i = 0;
  for (; i + LANES <= grid.rows(); i += LANES)
    apply<LANES>(along_cols_, transform, grid.template middleRows<LANES>(i));
  if (i < grid.rows()) apply<Eigen::Dynamic>(along_cols_, transform, grid.bottomRows(grid.rows() - i));
}

template <typename Number>
void Dct2d<Number>::forward(Grid& grid) {
  eachColumn(grid, &Dct<Number>::forward);
  eachRow(grid, &Dct<Number>::forward);
}

template <typename Number>
void Dct2d<Number>::inverse(Grid& coefficients) {
  eachRow(coefficients, &Dct<Number>::inverse);
  eachColumn(coefficients, &Dct<Number>::inverse);
}

template class Dct2d<float>;
template class Dct2d<double>;

Eigen::Index fastDctLength(Eigen::Index length) {
  constexpr Eigen::Index LARGEST_ODD_FACTOR = 15;
  Eigen::Index step = 1;
  while (length > (LARGEST_ODD_FACTOR + 1) * step) step *= 2;
  return (length + step - 1) / step * step;
}

}  // namespace pcl_fft_ground::core
