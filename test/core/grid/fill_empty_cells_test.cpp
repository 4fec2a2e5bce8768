#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "grid/distances.h"
#include "random_points.h"

namespace pcl_fft_ground::core {
namespace {

/// Every cell has a value of its own, so that the filled grid tells where each value came from.
Eigen::ArrayXXd numberedCells(Eigen::Index rows, Eigen::Index cols) {
  return Eigen::VectorXd::LinSpaced(rows * cols, 0, static_cast<double>(rows * cols - 1))
      .reshaped(rows, cols);
}

/// Number of the nearest observed cell; of equally near ones that of the lower column, then the lower row.
double slowNearest(const Mask& observed, Eigen::Index i, Eigen::Index j) {
  auto best = std::make_tuple(observed.size() * observed.size(), Eigen::Index(0), Eigen::Index(0));
  for (Eigen::Index c = 0; c < observed.cols(); ++c)
    for (Eigen::Index r = 0; r < observed.rows(); ++r)
      if (observed(r, c)) best = std::min(best, std::make_tuple((r - i) * (r - i) + (c - j) * (c - j), c, r));
  return static_cast<double>(std::get<2>(best) + std::get<1>(best) * observed.rows());
}

/// The filled grid against brute force: the distance of each source first, then the source itself.
void expectNearest(const Mask& observed) {
  const Eigen::ArrayXXd distances = distancesFrom(observed);
  Eigen::ArrayXXd filled = numberedCells(observed.rows(), observed.cols());
  fillEmptyCells(filled, observed);
  for (Eigen::Index j = 0; j < observed.cols(); ++j)
    for (Eigen::Index i = 0; i < observed.rows(); ++i) {
      const auto squaredDistance = [&](double number) {
        const auto n = static_cast<Eigen::Index>(number);
        const Eigen::Index di = n % observed.rows() - i, dj = n / observed.rows() - j;
        return di * di + dj * dj;
      };
      const double nearest = slowNearest(observed, i, j);
      ASSERT_EQ(squaredDistance(filled(i, j)), squaredDistance(nearest)) << "cell " << i << ", " << j;
      ASSERT_EQ(distances(i, j), std::sqrt(static_cast<double>(squaredDistance(nearest))));
      ASSERT_EQ(filled(i, j), nearest) << "tie at cell " << i << ", " << j;
    }
}

TEST(FillEmptyCells, TiesGoToTheLowerColumnThenTheLowerRow) {
  Eigen::ArrayXXd plus = numberedCells(3, 3);  // 0 3 6 / 1 4 7 / 2 5 8
  Mask observed(3, 3);
  observed << false, true, false,  //
      true, false, true,           //
      false, true, false;
  fillEmptyCells(plus, observed);
  Eigen::ArrayXXd expected(3, 3);
  expected << 1, 3, 3,  //
      1, 1, 7,          //
      1, 5, 5;
  EXPECT_TRUE((plus == expected).all()) << plus;

  Eigen::ArrayXXd column = numberedCells(3, 1);
  fillEmptyCells(column, (Mask(3, 1) << true, false, true).finished());
  EXPECT_EQ(column(1, 0), 0);
  Eigen::ArrayXXd row = numberedCells(1, 3);
  fillEmptyCells(row, (Mask(1, 3) << true, false, true).finished());
  EXPECT_EQ(row(0, 1), 0);
}

TEST(FillEmptyCells, LeavesFullAndUnobservedGridsAlone) {
  for (const bool observed : {true, false}) {
    SCOPED_TRACE(observed);
    Eigen::ArrayXXd values = numberedCells(4, 5);
    fillEmptyCells(values, Mask::Constant(4, 5, observed));
    EXPECT_TRUE((values == numberedCells(4, 5)).all());
  }
  Eigen::ArrayXXd none(0, 0);
  fillEmptyCells(none, Mask(0, 0));
  EXPECT_EQ(none.size(), 0);
}

TEST(FillEmptyCells, OneObservedCellFillsAll) {
  for (const Eigen::Index number : {0, 3, 17, 34}) {
    Eigen::ArrayXXd values = numberedCells(5, 7);
    Mask observed = Mask::Constant(5, 7, false);
    observed(number % 5, number / 5) = true;
    fillEmptyCells(values, observed);
    EXPECT_TRUE((values == static_cast<double>(number)).all()) << number;
  }
}

// Squares of such distances are beyond what products in 64 bits allow if one does not take care.
TEST(FillEmptyCells, AreExactAlongALineOfMillionsOfCells) {
  constexpr Eigen::Index CELLS = 8000000;
  for (const bool along_x : {true, false}) {
    SCOPED_TRACE(along_x);
    Eigen::ArrayXXd values = Eigen::ArrayXXd::Zero(along_x ? CELLS : 1, along_x ? 1 : CELLS);
    Mask observed = Mask::Constant(values.rows(), values.cols(), false);
    const std::vector<Eigen::Index> places = {10, 1000000, 3999999, 4000000, 7000001, 7999999};
    for (const Eigen::Index place : places) {
      values(place) = static_cast<double>(place);
      observed(place) = true;
    }
    fillEmptyCells(values, observed);
    for (std::size_t n = 0; n + 1 < places.size(); ++n) {
      const Eigen::Index middle = (places[n] + places[n + 1]) / 2;  // as near to the lower one, or nearer
      EXPECT_EQ(values(middle), static_cast<double>(places[n]));
      EXPECT_EQ(values(middle + 1), static_cast<double>(places[n + 1]));
    }
    EXPECT_EQ(values(0), 10);
  }
}

using Size = std::pair<Eigen::Index, Eigen::Index>;
class FillEmptyCellsOfSize : public testing::TestWithParam<std::tuple<Size, unsigned>> {};
INSTANTIATE_TEST_SUITE_P(SizesAndSeeds, FillEmptyCellsOfSize,
                         testing::Combine(testing::Values(Size(1, 1), Size(1, 40), Size(40, 1), Size(2, 3),
                                                          Size(13, 13), Size(8, 31), Size(29, 10)),
                                          testing::Range(1U, 5U)));

TEST_P(FillEmptyCellsOfSize, AgreesWithBruteForce) {
  const auto [size, seed] = GetParam();
  std::mt19937 random(seed);
  for (const double share : {0.01, 0.05, 0.2, 0.5, 0.9}) {
    SCOPED_TRACE(testing::Message() << size.first << " x " << size.second << ", seed " << seed
                                    << ", observed " << share);
    Mask observed =
        Mask::NullaryExpr(size.first, size.second, [&] { return test::uniform(random, 0, 1) < share; });
    observed(static_cast<Eigen::Index>(random()) % observed.size()) = true;
    expectNearest(observed);
  }
}

}  // namespace
}  // namespace pcl_fft_ground::core
