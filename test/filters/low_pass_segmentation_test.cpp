// FFTGroundSegmentation with the published estimator.

#include <complex>
#include <numeric>
#include <string>

#include "low_pass_fixture.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
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

}  // namespace
}  // namespace pcl_fft_ground::test
