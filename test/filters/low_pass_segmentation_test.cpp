// FFTGroundSegmentation with the published estimator.

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numeric>
#include <string>

#include "clouds.h"
#include "low_pass_segmentation.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {
namespace {

using Segmenter = LowPassSegmentation<pcl::PointXYZ>;

constexpr double CELL = 0.05;

/// A segmenter suited to boxScene(), with an input.
Segmenter segmenterOn(const Eigen::Matrix3Xf& points) {
  Segmenter segmenter;
  segmenter.setCellSize(CELL);
  segmenter.setMaximumObjectSize(0.8);
  segmenter.setInputCloud(cloudOf<pcl::PointXYZ>(points));
  return segmenter;
}

struct Parts {
  pcl::PointIndices ground, objects;
};

Parts segment(Segmenter& segmenter) {
  Parts parts;
  segmenter.segment(parts.ground, parts.objects);
  return parts;
}

std::vector<bool> objectFlags(Segmenter& segmenter) {
  std::vector<bool> flags(segmenter.getInputCloud()->size(), false);
  for (const pcl::index_t i : segment(segmenter).objects.indices) flags[static_cast<std::size_t>(i)] = true;
  return flags;
}

double heightAbove(const Segmenter& segmenter, std::size_t n) {
  return segmenter.getGroundSurface().heightAbove(
      (*segmenter.getInputCloud())[n].getVector3fMap().cast<double>());
}

/// Expects the labels of two runs to be equal but for points within 1e-6 m of the surface.
void expectSameLabels(Segmenter& first, Segmenter& second) {
  const std::vector<bool> a = objectFlags(first), b = objectFlags(second);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(std::count(a.begin(), a.end(), true), 100);
  for (std::size_t n = 0; n < a.size(); ++n)
    EXPECT_TRUE(a[n] == b[n] || std::abs(heightAbove(first, n)) <= 1e-6)
        << "point " << n << " at " << heightAbove(first, n) << " m";
}

/// The points turned, computed in double.
Eigen::Matrix3Xf turned(const Eigen::Matrix3Xf& points, double degrees, const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  return (rotation * points.cast<double>()).cast<float>();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Expects the call to throw a message that holds all the parts.
void expectRejected(const std::function<void()>& call, const std::vector<std::string>& parts) {
  try {
    call();
    ADD_FAILURE() << "accepted " << parts[1] << " as " << parts[0];
  } catch (const pcl::PCLException& error) {
    for (const std::string& part : parts) EXPECT_TRUE(contains(error.what(), part)) << error.what();
  }
}

TEST(LowPassSegmentation, DefaultsAreThePapers) {
  const Segmenter segmenter;
  EXPECT_EQ(segmenter.getCellSize(), 0.02);
  EXPECT_EQ(segmenter.getRelativeMaximumObjectSize(), 0.5);
  EXPECT_TRUE(std::isnan(segmenter.getMaximumObjectSize()));
  EXPECT_EQ(segmenter.getHeightTolerance(), 0.0);
  EXPECT_EQ(segmenter.getCutoffFrequency(), 0.0);
  EXPECT_EQ(segmenter.getFilterOrder(), 2U);
  EXPECT_EQ(segmenter.getPassbandRipple(), 3.0);
  EXPECT_EQ(segmenter.getPeakWindow(), 1U);
  EXPECT_EQ(segmenter.getPeakThreshold(), 0.0);
  EXPECT_EQ(segmenter.getGridLengths(), core::GridLengths::SMOOTH);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::PRINCIPAL_AXIS);
  EXPECT_EQ(segmenter.getYaw(), Yaw::MIN_AREA_RECTANGLE);
  EXPECT_EQ(segmenter.getUpDirection(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(segmenter.getElevationGrid().elevation.size(), 0);
  EXPECT_EQ(segmenter.getGroundSurface().height.size(), 0);
  EXPECT_TRUE(segmenter.getSpectrumPeaks().empty());
  EXPECT_TRUE(segmenter.getFrame().isApprox(Eigen::Isometry3d::Identity(), 0.0));
}

TEST(LowPassSegmentation, SettersReadBack) {
  Segmenter segmenter;
  segmenter.setCellSize(0.5);
  segmenter.setHeightTolerance(-0.25);
  segmenter.setCutoffFrequency(M_SQRT2);
  segmenter.setFilterOrder(7);
  segmenter.setPassbandRipple(0.5);
  segmenter.setPeakWindow(3);
  segmenter.setPeakThreshold(1.5);
  segmenter.setGridLengths(core::GridLengths::EXACT);
  EXPECT_EQ(segmenter.getCellSize(), 0.5);
  EXPECT_EQ(segmenter.getHeightTolerance(), -0.25);
  EXPECT_EQ(segmenter.getCutoffFrequency(), M_SQRT2);
  EXPECT_EQ(segmenter.getFilterOrder(), 7U);
  EXPECT_EQ(segmenter.getPassbandRipple(), 0.5);
  EXPECT_EQ(segmenter.getPeakWindow(), 3U);
  EXPECT_EQ(segmenter.getPeakThreshold(), 1.5);
  EXPECT_EQ(segmenter.getGridLengths(), core::GridLengths::EXACT);
}

TEST(LowPassSegmentation, InvalidValuesAreNamedWithTheirRange) {
  Segmenter s;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const auto& [value, text] : std::vector<std::pair<double, std::string>>{
           {0.0, "0"}, {-0.5, "-0.5"}, {nan, "nan"}, {infinity, "inf"}}) {
    const double v = value;
    expectRejected([&] { s.setCellSize(v); }, {"cell size", text, "above 0"});
    expectRejected([&] { s.setMaximumObjectSize(v); }, {"maximum object size", text, "above 0"});
    expectRejected([&] { s.setRelativeMaximumObjectSize(v); },
                   {"relative maximum object size", text, "(0, 1]"});
    expectRejected([&] { s.setPassbandRipple(v); }, {"passband ripple", text, "(0, 100]"});
  }
  expectRejected([&] { s.setRelativeMaximumObjectSize(1.25); },
                 {"relative maximum object size", "1.25", "(0, 1]"});
  expectRejected([&] { s.setHeightTolerance(nan); }, {"height tolerance", "nan", "finite"});
  expectRejected([&] { s.setHeightTolerance(infinity); }, {"height tolerance", "inf", "finite"});
  expectRejected([&] { s.setCutoffFrequency(-0.1); }, {"cut-off frequency", "-0.1", "(0, 1.41421]"});
  expectRejected([&] { s.setCutoffFrequency(1.5); }, {"cut-off frequency", "1.5", "(0, 1.41421]"});
  expectRejected([&] { s.setCutoffFrequency(nan); }, {"cut-off frequency", "nan", "(0, 1.41421]"});
  expectRejected([&] { s.setFilterOrder(0); }, {"filter order", "0", "[1, 100]"});
  expectRejected([&] { s.setFilterOrder(101); }, {"filter order", "101", "[1, 100]"});
  expectRejected([&] { s.setPassbandRipple(101); }, {"passband ripple", "101", "(0, 100]"});
  expectRejected([&] { s.setPeakWindow(0); }, {"peak window", "0", "[1, 1000]"});
  expectRejected([&] { s.setPeakWindow(1001); }, {"peak window", "1001", "[1, 1000]"});
  expectRejected([&] { s.setPeakThreshold(-1); }, {"peak threshold", "-1", "at least 0"});
  expectRejected([&] { s.setPeakThreshold(infinity); }, {"peak threshold", "inf", "finite"});
  EXPECT_EQ(s.getCellSize(), 0.02);  // nothing of it was kept
  EXPECT_EQ(s.getFilterOrder(), 2U);
}

TEST(LowPassSegmentation, ElevationGridHoldsTheHighestPointOfEachCell) {
  const Scene scene = boxScene();
  Segmenter segmenter = segmenterOn(scene.points);
  segment(segmenter);
  const core::ElevationGrid& grid = segmenter.getElevationGrid();
  const core::GridGeometry& cells = grid.geometry;
  ASSERT_EQ(grid.elevation.rows(), cells.rows);
  ASSERT_EQ(grid.elevation.cols(), cells.cols);
  EXPECT_EQ(cells.cell_size, CELL);
  Eigen::ArrayXXd highest = Eigen::ArrayXXd::Constant(cells.rows, cells.cols, -1e9);
  for (Eigen::Index n = 0; n < scene.points.cols(); ++n) {
    const Eigen::Vector3d p = segmenter.getFrame() * scene.points.col(n).cast<double>();
    const Eigen::Vector2d cell = (p.head<2>() - cells.origin) / CELL;
    const auto i =
        std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(cell.x())), 0, cells.rows - 1);
    const auto j =
        std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(cell.y())), 0, cells.cols - 1);
    highest(i, j) = std::max(highest(i, j), p.z());
  }
  const core::Mask expected_observed = highest > -1e8;
  EXPECT_TRUE((grid.observed == expected_observed).all());
  EXPECT_LT((grid.observed.select(grid.elevation - highest, 0.0)).abs().maxCoeff(), 1e-6);
  const double empty =
      static_cast<double>((!expected_observed).count()) / static_cast<double>(highest.size());
  EXPECT_NEAR(segmenter.getEmptyCellShare(), empty, 1e-12);
}

/// One bin of the transform of a grid, by its definition.
std::complex<double> slowTransform(const Eigen::ArrayXXd& grid, Eigen::Index k, Eigen::Index l) {
  std::complex<double> sum = 0;
  for (Eigen::Index j = 0; j < grid.cols(); ++j)
    for (Eigen::Index i = 0; i < grid.rows(); ++i) {
      const double turns = static_cast<double>(i * k) / static_cast<double>(grid.rows()) +
                           static_cast<double>(j * l) / static_cast<double>(grid.cols());
      sum += grid(i, j) * std::polar(1.0, -2 * M_PI * turns);
    }
  return sum;
}

TEST(LowPassSegmentation, SpectrumBeforeAndAfterTheFilter) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segmenter.setGridLengths(core::GridLengths::EXACT);
  segmenter.setFilterOrder(3);
  segmenter.setPassbandRipple(2);
  segment(segmenter);
  const Eigen::ArrayXXd& elevation = segmenter.getElevationGrid().elevation;
  const core::Spectrum& before = segmenter.getSpectrum();
  const core::Spectrum after = segmenter.getFilteredSpectrum();
  ASSERT_EQ(before.rows, elevation.rows());
  ASSERT_EQ(before.cols(), elevation.cols());
  const double f_c = segmenter.getCutoffFrequency();
  const double ripple = std::pow(10.0, 0.2) - 1;
  for (const auto& [k, l] : std::vector<std::pair<Eigen::Index, Eigen::Index>>{
           {0, 0}, {1, 0}, {0, 1}, {3, 2}, {5, before.cols() - 4}, {before.rows / 2, before.cols() / 2}}) {
    EXPECT_LT(std::abs(before.half(k, l) - slowTransform(elevation, k, l)), 1e-8) << k << ' ' << l;
    const double x = 2.0 * static_cast<double>(k) / static_cast<double>(before.rows);
    const double y =
        2.0 * static_cast<double>(std::min(l, before.cols() - l)) / static_cast<double>(before.cols());
    const double gain = 1 / std::sqrt(1 + ripple * std::pow((x * x + y * y) / (f_c * f_c), 3));
    EXPECT_LT(std::abs(after.half(k, l) - gain * before.half(k, l)), 1e-8) << k << ' ' << l;
    EXPECT_LT(std::abs(slowTransform(segmenter.getGroundSurface().height, k, l) - after.half(k, l)), 1e-8);
  }
}

TEST(LowPassSegmentation, AutomaticCutoffIsTheFirstPeakThatKeepsObjectsOut) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segment(segmenter);
  const std::vector<core::SpectrumPeak>& peaks = segmenter.getSpectrumPeaks();
  const core::Cutoff& cutoff = segmenter.getCutoff();
  ASSERT_TRUE(cutoff.peak.has_value());
  EXPECT_EQ(segmenter.getCutoffFrequency(), cutoff.frequency);
  EXPECT_EQ(cutoff.peak->radius, cutoff.frequency);
  EXPECT_NEAR(cutoff.object_size, 2 * CELL / cutoff.frequency, 1e-12);
  EXPECT_LE(cutoff.object_size, 0.8);
  for (std::size_t n = 1; n < peaks.size(); ++n) EXPECT_LE(peaks[n - 1].radius, peaks[n].radius);
  const auto first = std::find_if(peaks.begin(), peaks.end(),
                                  [](const core::SpectrumPeak& p) { return 2 * CELL / p.radius <= 0.8; });
  ASSERT_NE(first, peaks.end());
  EXPECT_EQ(first->radius, cutoff.frequency);
}

TEST(LowPassSegmentation, GivenCutoffIsUsedUntilItIsAutomaticAgain) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segment(segmenter);
  const double automatic = segmenter.getCutoffFrequency();
  segmenter.setCutoffFrequency(0.25);
  EXPECT_EQ(segmenter.getCutoffFrequency(), 0.25);
  segment(segmenter);
  EXPECT_EQ(segmenter.getCutoffFrequency(), 0.25);
  EXPECT_EQ(segmenter.getCutoff().frequency, 0.25);
  EXPECT_NEAR(segmenter.getCutoff().object_size, 2 * CELL / 0.25, 1e-12);
  EXPECT_FALSE(segmenter.getCutoff().peak.has_value());
  EXPECT_FALSE(segmenter.getSpectrumPeaks().empty());
  segmenter.setCutoffFrequency(0);
  EXPECT_EQ(segmenter.getCutoffFrequency(), 0.0);
  segment(segmenter);
  EXPECT_EQ(segmenter.getCutoffFrequency(), automatic);
}

TEST(LowPassSegmentation, WithoutAPeakTheCutoffFollowsFromTheSize) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segmenter.setPeakThreshold(1e6);  // no bin stands out by that much
  segment(segmenter);
  EXPECT_TRUE(segmenter.getSpectrumPeaks().empty());
  EXPECT_FALSE(segmenter.getCutoff().peak.has_value());
  EXPECT_NEAR(segmenter.getCutoffFrequency(), 2 * CELL / 0.8, 1e-12);
}

TEST(LowPassSegmentation, OfTwoSizesTheLaterCallWins) {
  Segmenter segmenter;
  segmenter.setMaximumObjectSize(1.5);
  EXPECT_EQ(segmenter.getMaximumObjectSize(), 1.5);
  EXPECT_TRUE(std::isnan(segmenter.getRelativeMaximumObjectSize()));
  segmenter.setRelativeMaximumObjectSize(0.25);
  EXPECT_EQ(segmenter.getRelativeMaximumObjectSize(), 0.25);
  EXPECT_TRUE(std::isnan(segmenter.getMaximumObjectSize()));
  segmenter.setMaximumObjectSize(2);
  EXPECT_EQ(segmenter.getMaximumObjectSize(), 2.0);
  EXPECT_TRUE(std::isnan(segmenter.getRelativeMaximumObjectSize()));
}

TEST(LowPassSegmentation, RelativeSizeIsAShareOfTheSmallerExtent) {
  Segmenter relative = segmenterOn(boxScene().points), in_metres = segmenterOn(boxScene().points);
  for (Segmenter* segmenter : {&relative, &in_metres}) {
    segmenter->setUpEstimation(UpEstimation::GIVEN);  // the rectangle is exactly 4 m x 2.5 m
    segmenter->setPeakThreshold(1e6);                 // so that the size alone decides
  }
  relative.setRelativeMaximumObjectSize(0.2);
  in_metres.setMaximumObjectSize(0.5);
  segment(relative);
  segment(in_metres);
  EXPECT_NEAR(relative.getCutoffFrequency(), in_metres.getCutoffFrequency(), 1e-6);
}

TEST(LowPassSegmentation, LabelsFollowFromTheSurface) {
  const Scene scene = boxScene();
  for (const double tolerance : {-0.05, 0.0, 0.1}) {
    Segmenter segmenter = segmenterOn(scene.points);
    segmenter.setHeightTolerance(tolerance);
    const std::vector<bool> flags = objectFlags(segmenter);
    for (std::size_t n = 0; n < flags.size(); ++n) {
      const double height = heightAbove(segmenter, n) - tolerance;
      EXPECT_TRUE(flags[n] == (height > 0) || std::abs(height) <= 1e-6) << n << " at " << height;
    }
  }
}

TEST(LowPassSegmentation, FindsTheBoxes) {
  const Scene scene = boxScene();
  Segmenter segmenter = segmenterOn(scene.points);
  segmenter.setMaximumObjectSize(2);  // the lower the cut-off, the less the boxes lift the ground
  segmenter.setHeightTolerance(0.12);
  const std::vector<bool> flags = objectFlags(segmenter);
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < flags.size(); ++n) wrong += flags[n] == scene.is_object[n] ? 0 : 1;
  EXPECT_EQ(wrong, 0U);
}

TEST(LowPassSegmentation, WarnsOfEmptyCells) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segment(segmenter);
  EXPECT_LE(segmenter.getEmptyCellShare(), 0.1);
  EXPECT_TRUE(segmenter.getWarnings().empty());
  segmenter.setCellSize(0.02);
  const OutputCapture capture;
  segment(segmenter);
  EXPECT_GT(segmenter.getEmptyCellShare(), 0.5);
  ASSERT_EQ(segmenter.getWarnings().size(), 1U);
  EXPECT_TRUE(contains(segmenter.getWarnings()[0], "elevation cells"));
  EXPECT_TRUE(contains(capture.standard_error.text(), segmenter.getWarnings()[0]));
  EXPECT_EQ(capture.standard_output.text(), "");
}

TEST(LowPassSegmentation, WarnsOfASizeAboveTheExtentAndUsesIt) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segmenter.setMaximumObjectSize(50);
  const OutputCapture capture;
  segment(segmenter);
  ASSERT_EQ(segmenter.getWarnings().size(), 1U);
  EXPECT_TRUE(contains(segmenter.getWarnings()[0], "50 m"));
  EXPECT_TRUE(contains(capture.standard_error.text(), segmenter.getWarnings()[0]));
  EXPECT_EQ(segmenter.getMaximumObjectSize(), 50.0);
  ASSERT_FALSE(segmenter.getSpectrumPeaks().empty());
  EXPECT_EQ(segmenter.getCutoffFrequency(), segmenter.getSpectrumPeaks().front().radius);
}

TEST(LowPassSegmentation, TooLargeAGridIsReportedAndAllIsGround) {
  const auto cloud = cloudOf<pcl::PointXYZ>(boxScene().points);
  spoilPoints(*cloud);
  Segmenter segmenter;
  segmenter.setInputCloud(cloud);
  segment(segmenter);
  EXPECT_TRUE(segmenter.getError().empty());
  segmenter.setCellSize(1e-9);
  const OutputCapture capture;
  Parts parts;
  EXPECT_NO_THROW(parts = segment(segmenter));
  EXPECT_TRUE(contains(segmenter.getError(), "1e-09"));
  EXPECT_TRUE(contains(capture.standard_error.text(), segmenter.getError()));
  EXPECT_TRUE(parts.objects.indices.empty());
  const auto finite = std::count_if(cloud->begin(), cloud->end(), isFinitePoint<pcl::PointXYZ>);
  EXPECT_EQ(parts.ground.indices.size(), static_cast<std::size_t>(finite));
  EXPECT_EQ(segmenter.getElevationGrid().elevation.size(), 0);  // nothing left of the run before
  EXPECT_TRUE(segmenter.getSpectrumPeaks().empty());

  segmenter.setCellSize(CELL);
  EXPECT_FALSE(segment(segmenter).objects.indices.empty());
  EXPECT_TRUE(segmenter.getError().empty());
}

TEST(LowPassSegmentation, InvalidIndicesLeaveNothingOfTheRunBefore) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segment(segmenter);
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  const OutputCapture capture;
  segment(segmenter);
  EXPECT_FALSE(segmenter.getError().empty());
  EXPECT_EQ(segmenter.getElevationGrid().elevation.size(), 0);
  EXPECT_EQ(segmenter.getGroundSurface().height.size(), 0);
}

TEST(LowPassSegmentation, AFarPointDoesNotStretchTheGrid) {
  const Scene scene = boxScene();
  Segmenter undisturbed = segmenterOn(scene.points);
  segment(undisturbed);
  Eigen::Matrix3Xf points = scene.points;
  points.conservativeResize(Eigen::NoChange, points.cols() + 2);
  points.rightCols<2>() << 1e6f, 0, 0, -1e6f, 0, 1e6f;
  Segmenter segmenter = segmenterOn(points);
  const OutputCapture capture;
  const Parts parts = segment(segmenter);
  const auto first = static_cast<pcl::index_t>(scene.points.cols());
  EXPECT_EQ(segmenter.getFarPoints(), (pcl::Indices{first, first + 1}));
  EXPECT_EQ(segmenter.getElevationGrid().geometry.rows, undisturbed.getElevationGrid().geometry.rows);
  EXPECT_EQ(segmenter.getElevationGrid().geometry.cols, undisturbed.getElevationGrid().geometry.cols);
  EXPECT_EQ(segmenter.getCutoffFrequency(), undisturbed.getCutoffFrequency());
  EXPECT_EQ(parts.objects.indices.back(), first + 1);
  segmenter.setInputCloud(undisturbed.getInputCloud());
  segment(segmenter);
  EXPECT_TRUE(segmenter.getFarPoints().empty());
}

TEST(LowPassSegmentation, FrameBringsTheCentroidToTheOrigin) {
  const Scene scene = boxScene();
  Segmenter segmenter = segmenterOn(scene.points);
  segment(segmenter);
  const Eigen::Vector3d centroid = scene.points.cast<double>().rowwise().mean();
  EXPECT_LT((segmenter.getFrame() * centroid).norm(), 1e-5);
  const Eigen::Matrix3d rotation = segmenter.getFrame().linear();
  EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(rotation(2, 2), 0.99);
}

TEST(LowPassSegmentation, UpDirectionChoosesTheSideThatIsUp) {
  Segmenter segmenter = segmenterOn(boxScene().points);
  segmenter.setUpDirection(-Eigen::Vector3d::UnitZ());
  segment(segmenter);
  EXPECT_LT(segmenter.getFrame().linear()(2, 2), -0.99);
  segmenter.setUpEstimation(UpEstimation::GIVEN);
  segmenter.setUpDirection(Eigen::Vector3d(0, 1e-3, 1e-3));
  segment(segmenter);
  EXPECT_TRUE((segmenter.getFrame().linear() * Eigen::Vector3d(0, M_SQRT1_2, M_SQRT1_2))
                  .isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
}

TEST(LowPassSegmentation, LabelsDoNotDependOnWhereTheSceneLies) {
  const Eigen::Matrix3Xf points = boxScene().points;
  const Eigen::Matrix3Xf moved = points.colwise() + Eigen::Vector3f(16, -8, 4);  // exact in float
  Segmenter here = segmenterOn(points), there = segmenterOn(moved);
  expectSameLabels(here, there);
}

TEST(LowPassSegmentation, LabelsDoNotDependOnAQuarterTurnAboutUp) {
  const Eigen::Matrix3Xf points = boxScene().points;
  Eigen::Matrix3Xf quarter = points;
  quarter.row(0) = -points.row(1);
  quarter.row(1) = points.row(0);
  // The grid starts at another corner after the turn. It is the same grid, to 0.7 micrometres, if the cells
  // fill the rectangle of 4 m x 2.5 m.
  Segmenter straight = segmenterOn(points), turned_scene = segmenterOn(quarter);
  for (Segmenter* segmenter : {&straight, &turned_scene}) {
    segmenter->setCellSize(CELL * (1 + 1.8e-7));
    segmenter->setUpEstimation(UpEstimation::GIVEN);
  }
  segment(straight);
  segment(turned_scene);
  ASSERT_EQ(straight.getElevationGrid().elevation.size(), 80 * 50);
  ASSERT_EQ(turned_scene.getElevationGrid().elevation.size(), 80 * 50);
  expectSameLabels(straight, turned_scene);
}

TEST(LowPassSegmentation, LabelsDoNotDependOnPointOrder) {
  const Eigen::Matrix3Xf points = boxScene().points;
  const Eigen::Matrix3Xf reversed = points.rowwise().reverse();
  Segmenter forward = segmenterOn(points), backward = segmenterOn(reversed);
  std::vector<bool> backward_flags = objectFlags(backward);
  std::reverse(backward_flags.begin(), backward_flags.end());
  EXPECT_EQ(objectFlags(forward), backward_flags);
}

TEST(LowPassSegmentation, ATiltedSceneGivesTheLabelsOfTheLevelOne) {
  // Turned off the axes, so that the yaw of the grid does not stand where it may jump by a quarter turn.
  const Eigen::Matrix3Xf level = turned(boxScene().points, 20, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3Xf tilted = turned(level, 30, Eigen::Vector3d(1, 0, 0));
  Segmenter on_level = segmenterOn(level), on_tilted = segmenterOn(tilted);
  expectSameLabels(on_level, on_tilted);
}

}  // namespace
}  // namespace pcl_fft_ground::test
