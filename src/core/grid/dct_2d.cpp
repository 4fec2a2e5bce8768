#include <algorithm>

#include "grid/dct.h"
#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::core {
namespace {

constexpr Eigen::Index LINES_AT_A_TIME = 64;

}  // namespace

template <typename Number>
Dct2d<Number>::Dct2d(Eigen::Index rows, Eigen::Index cols) : along_rows_(rows), along_cols_(cols) {}

/// Transforms lines that are the rows of a block; a number of them known to the compiler is copied faster.
/// \param scratch twice as long as a line
template <typename Number>
template <int LinesAtCompileTime, typename Lines>
void Dct2d<Number>::apply(const Dct<Number>& dct, Transform transform, std::vector<Lanes>& scratch,
                          Lines&& lines) {
  Eigen::Map<Eigen::Array<Number, Lanes::SizeAtCompileTime, Eigen::Dynamic>> all(
      scratch.data()->data(), Lanes::SizeAtCompileTime, dct.length());
  auto own = all.template topRows<LinesAtCompileTime>(lines.rows());
  own = lines;
  (dct.*transform)(scratch.data(), scratch.data() + dct.length());
  lines = own;
}

template <typename Number>
void Dct2d<Number>::eachColumn(Grid& grid, Transform transform) const {
  constexpr int LANES = Lanes::SizeAtCompileTime;
  forEachRange(grid.cols(), LINES_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    std::vector<Lanes> scratch(static_cast<std::size_t>(2 * grid.rows()), Lanes::Zero());
    Eigen::Index j = begin;
    for (; j + LANES <= end; j += LANES)
      apply<LANES>(along_rows_, transform, scratch, grid.template middleCols<LANES>(j).transpose());
    if (j < end)
      apply<Eigen::Dynamic>(along_rows_, transform, scratch, grid.middleCols(j, end - j).transpose());
  });
}

template <typename Number>
void Dct2d<Number>::eachRow(Grid& grid, Transform transform) const {
  constexpr int LANES = Lanes::SizeAtCompileTime;
  forEachRange(grid.rows(), LINES_AT_A_TIME, [&](Eigen::Index begin, Eigen::Index end) {
    std::vector<Lanes> scratch(static_cast<std::size_t>(2 * grid.cols()), Lanes::Zero());
    Eigen::Index i = begin;
    for (; i + LANES <= end; i += LANES)
      apply<LANES>(along_cols_, transform, scratch, grid.template middleRows<LANES>(i));
    if (i < end) apply<Eigen::Dynamic>(along_cols_, transform, scratch, grid.middleRows(i, end - i));
  });
}

template <typename Number>
void Dct2d<Number>::forward(Grid& grid) const {
  eachColumn(grid, &Dct<Number>::forward);
  eachRow(grid, &Dct<Number>::forward);
}

template <typename Number>
void Dct2d<Number>::inverse(Grid& coefficients) const {
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
