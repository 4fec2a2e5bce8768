#include "pcl_fft_ground/core/tiles/tile_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "large_site.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/core/tiles/site_summary.h"
#include "pcl_fft_ground/core/tiles/tile_segments.h"

namespace pcl_fft_ground::core {
namespace {

struct Site {
  PreparedScan scan;
  RobustParameters parameters;
  const Points& points() const { return scan.usable.points; }
};

Site siteOf(double side, Eigen::Index count, std::uint32_t seed) {
  const test::LargeSite site(side, seed);
  RawPoints points(3, count);
  for (Eigen::Index n = 0; n < count; ++n) points.col(n) = site.point(static_cast<std::uint64_t>(n)).place;
  Site result;
  result.scan = prepare(points, FrameParameters());
  result.parameters.max_object_size = 1;
  return result;
}

Points pointsIn(const Points& points, const Tiling& tiling, const CellWindow& window,
                std::vector<std::size_t>* columns = nullptr) {
  Points result(3, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const auto [i, j] = tiling.cellAt(points(0, n), points(1, n));
    if (!window.contains(i, j)) continue;
    result.col(count++) = points.col(n);
    if (columns != nullptr) columns->push_back(static_cast<std::size_t>(n));
  }
  return result.leftCols(count);
}

Labels labelsByTiles(const Site& site, double tile_size) {
  const Points& points = site.points();
  RobustPlan plan = planRobustGround(site.parameters, boundsOf(points), points.cols());
  const Tiling tiling = tilingOf(plan, tile_size);
  std::vector<TileGround> tiles;
  std::vector<TileSpread> spreads;
  Eigen::Index observed = 0;
  const auto fit = [&](std::size_t t) {
    return fitTile(pointsIn(points, tiling, tiling.seen(t)), site.scan.frame_from_input, plan,
                   site.parameters, tiling, t);
  };
  for (std::size_t t = 0; t < tiling.size(); ++t) tiles.push_back(fit(t));
  std::vector<StandingRegion> standing;
  for (const TileGround& tile : tiles)
    standing.insert(standing.end(), tile.ground.standing.begin(), tile.ground.standing.end());
  const SiteBreaks breaks = breaksOf(plan, standing);
  plan = withBreaks(plan, breaks);
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    if (contradicts(tiles[t], breaks, tiling, t)) tiles[t] = fit(t);
    spreads.push_back(spreadOf(tiles[t], tiling.core(t)));
    observed += spreads.back().observed;
  }
  const auto groundOf = [&](std::size_t t) {
    std::vector<TileGround> blended;
    for (const std::size_t other : blendedTiles(tiling, t)) blended.push_back(tiles[other]);
    RobustGround ground = blendedGround(tiling, t, blended).ground;
    ground.scale = siteSpread(spreads);
    ground.max_object_size = plan.max_object_size;
    chooseTolerances(site.parameters, plan, observed, ground);
    return ground;
  };
  ClearanceCounts counts;
  for (std::size_t t = 0; t < tiling.size(); ++t)
    counts.add(clearancesOf(pointsIn(plannedSample(points, plan), tiling, tiling.core(t)), groundOf(t)));
  Labels labels(static_cast<std::size_t>(points.cols()), Label::NEITHER);
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    RobustGround ground = groundOf(t);
    widenTolerance(site.parameters, counts, ground);
    std::vector<std::size_t> columns;
    const Points own = pointsIn(points, tiling, tiling.core(t), &columns);
    const RobustLabels found = labelRobust(own, ground);
    for (std::size_t n = 0; n < columns.size(); ++n) labels[columns[n]] = found.labels[n];
  }
  return labels;
}

double agreement(const Labels& a, const Labels& b) {
  std::size_t same = 0;
  for (std::size_t n = 0; n < a.size(); ++n) same += a[n] == b[n] ? 1 : 0;
  return static_cast<double>(same) / static_cast<double>(a.size());
}

class TileGroundOfSeeds : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, TileGroundOfSeeds, testing::Values(1, 2, 3));

TEST_P(TileGroundOfSeeds, LabelsAgreeWithThoseOfTheWholeSite) {
  SCOPED_TRACE(GetParam());
  const Site site = siteOf(12, 300000, GetParam());
  const RobustGround whole = estimateRobustGround(site.points(), site.scan.frame_from_input, site.parameters);
  const Labels expected = labelRobust(site.points(), whole).labels;
  const Labels labels = labelsByTiles(site, 4.5);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), Label::NEITHER), 0);
  EXPECT_GE(agreement(expected, labels), 0.9993);  // tiles of 4.5 objects: .99943, .99998 and more
}

TEST(Tiling, TilesHoldEveryCellOnceAndAreOfOneSize) {
  const GridGeometry site{{-3, 7}, 0.1, 103, 41};
  const Tiling tiling(site, 2.5, 1);
  EXPECT_EQ(tiling.margin(), 10);
  Eigen::ArrayXXi holders = Eigen::ArrayXXi::Zero(site.rows, site.cols);
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const CellWindow core = tiling.core(t);
    EXPECT_LE(core.rows, 25);
    EXPECT_GE(core.rows, 20);
    EXPECT_LE(core.cols, 25);
    holders.block(core.row, core.col, core.rows, core.cols) += 1;
    EXPECT_EQ(tiling.tileAt(core.row, core.col), t);
    EXPECT_EQ(tiling.tileAt(core.row + core.rows - 1, core.col + core.cols - 1), t);
    EXPECT_EQ(tiling.tilesIn(core), std::vector<std::size_t>{t});
  }
  EXPECT_TRUE((holders == 1).all());
  EXPECT_EQ(tiling.tilesIn({0, 0, site.rows, site.cols}).size(), tiling.size());
}

TEST(BlendedGround, IsThatOfTheTilesWhereTheyAgree) {
  RobustPlan plan;
  plan.cells = {{0, 0}, 0.1, 60, 50};
  plan.max_object_size = 1;
  const Tiling tiling = tilingOf(plan, 3);
  const auto plane = [](const CellWindow& w, Eigen::Index i, Eigen::Index j) {
    return 0.1 * static_cast<double>(w.row + i) - 0.03 * static_cast<double>(w.col + j);
  };
  std::vector<TileGround> grounds;
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    TileGround ground = fitTile(Points(3, 0), Eigen::Isometry3d::Identity(), plan, {}, tiling, t);
    ground.ground.scale = 0.01;
    for (Eigen::Index j = 0; j < ground.window.cols; ++j)
      for (Eigen::Index i = 0; i < ground.window.rows; ++i)
        ground.ground.surface.height(i, j) = plane(ground.window, i, j);
    grounds.push_back(ground);
  }
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    std::vector<TileGround> near;
    for (const std::size_t other : blendedTiles(tiling, t)) near.push_back(grounds[other]);
    const TileGround blended = blendedGround(tiling, t, near);
    for (Eigen::Index j = 0; j < blended.window.cols; ++j)
      for (Eigen::Index i = 0; i < blended.window.rows; ++i)
        EXPECT_NEAR(blended.ground.surface.height(i, j), plane(blended.window, i, j), 1e-12);
  }
}

TEST(SiteBreaks, ARegionOverASeamIsJudgedAsOne) {
  RobustPlan plan;
  plan.cells = {{0, 0}, 0.1, 40, 40};
  plan.max_object_size = 1;
  StandingRegion left;  // broad, 0.6 of the square of the largest object: an object may be as large
  left.slope = BreakSlope::GENTLE;
  left.low_row = 0, left.high_row = 9, left.low_col = 0, left.high_col = 19;
  left.area = 60;
  left.broad = true;
  left.seam = {{5, 19}};
  StandingRegion right = left;
  right.low_col = 20, right.high_col = 39;
  right.seam = {{6, 20}};
  const SiteBreaks together = breaksOf(plan, {left, right});
  EXPECT_TRUE(together.land_breaks);
  EXPECT_EQ(together.verdicts.size(), 2U);  // that their tiles did not know
  right.seam = {{8, 20}};
  const SiteBreaks apart = breaksOf(plan, {left, right});
  EXPECT_FALSE(apart.land_breaks);
  EXPECT_TRUE(apart.verdicts.empty());
  right.seam = {{6, 20}};
  right.slope = BreakSlope::PROOF;
  EXPECT_FALSE(breaksOf(plan, {left, right}).land_breaks) << "regions of different slopes";
}

TEST(SiteSpread, IsTheMedianOverTheObservedCells) {
  EXPECT_EQ(siteSpread({}), 0);
  EXPECT_EQ(siteSpread({{0.5, 0}, {0.1, 3}}), 0.1);
  EXPECT_EQ(siteSpread({{0.3, 10}, {0.1, 1}, {0.2, 30}}), 0.2);
}

TEST(SiteSummary, PartsGiveTheFrameOfTheWhole) {
  const test::LargeSite site(9, 5);
  RawPoints points(3, 20000);
  for (Eigen::Index n = 0; n < points.cols(); ++n)
    points.col(n) = Eigen::AngleAxisf(0.3F, Eigen::Vector3f(0.1F, 0.05F, 1).normalized()) *
                    site.point(static_cast<std::uint64_t>(n)).place;
  points.col(7).x() = std::numeric_limits<float>::quiet_NaN();
  points.col(19).setConstant(1e6F);
  const FrameParameters parameters;
  const PreparedScan whole = prepare(points, parameters);
  const SiteBounds bounds(points);
  EXPECT_EQ(bounds.useOf(points.col(7)), PointUse::UNUSABLE);
  EXPECT_EQ(bounds.useOf(points.col(19)), PointUse::FAR);
  const auto eachPart = [&](const auto& visit) {
    for (Eigen::Index n = 0; n < points.cols(); n += 3000)
      visit(bounds.usedOf(points.middleCols(n, std::min<Eigen::Index>(3000, points.cols() - n))));
  };
  BoundsInParts in_parts;
  eachPart([&](const Points& part) { in_parts.add(part); });
  EXPECT_EQ(in_parts.points(), whole.usable.points.cols());
  StatisticsInParts statistics(in_parts);
  eachPart([&](const Points& part) { statistics.add(part); });
  const PointStatistics found = statistics.statistics();
  EXPECT_EQ(found.mean, whole.usable.statistics.mean);
  EXPECT_EQ(found.covariance, whole.usable.statistics.covariance);
  LevelFrameInParts frame(found, whole.up.axis);
  eachPart([&](const Points& part) { frame.add(part); });
  const LevelFrameInParts::Result result = frame.result(parameters.yaw);
  EXPECT_EQ(result.frame_from_input.matrix(), whole.frame_from_input.matrix());
  const Bounds expected = boundsOf(whole.usable.points);
  EXPECT_TRUE((result.bounds.low == expected.low).all());
  EXPECT_TRUE((result.bounds.high == expected.high).all());
}

TEST(TileSegments, WhatTouchesAcrossASeamIsOne) {
  TileSegments segments({5, 7, 4, 1});
  segments.join({{0, 2}}, SeamRule::ANY);
  EXPECT_EQ(segments.numbers(1, 100), (std::vector<std::int32_t>{1, 2, 1, 3}));
  EXPECT_EQ(segments.numbers(2, 8), (std::vector<std::int32_t>{0, 1, 0, 0}));
}

TEST(TileSegments, ObjectsAreOneWhereMostOfThemIsCommon) {
  TileSegments segments({50, 50, 50, 50});
  std::vector<SeamPoint> seam(10, SeamPoint{0, 2});
  seam.insert(seam.end(), 9, SeamPoint{1, 3});
  seam.insert(seam.end(), 3, SeamPoint{0, 3});  // their border is drawn a little differently in both
  segments.join(seam, SeamRule::MOST);
  EXPECT_EQ(segments.numbers(1, 1000), (std::vector<std::int32_t>{1, 2, 1, 2}));
}

}  // namespace
}  // namespace pcl_fft_ground::core
