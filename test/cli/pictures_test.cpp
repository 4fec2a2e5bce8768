#include "pictures/pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "errors.h"
#include "pictures/colour_map.h"
#include "pictures/spectrum_raster.h"
#include "png.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;
using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kMagenta = 0xff00ffU;

/// Largest difference of a channel between two colours 0xRRGGBB.
int difference(std::uint32_t a, std::uint32_t b) {
  int largest = 0;
  for (const unsigned shift : {0U, 8U, 16U})
    largest = std::max(largest,
                       std::abs(static_cast<int>(a >> shift & 255U) - static_cast<int>(b >> shift & 255U)));
  return largest;
}

std::uint32_t rgb(const Colour& colour) {
  return packed(colour) & kWhite;
}

/// How much more red and blue than green a colour has: 255 for magenta, about 0 for the spectrum's palette.
int magentaOf(std::uint32_t colour) {
  const auto red = static_cast<int>(colour >> 16U & 255U);
  const auto green = static_cast<int>(colour >> 8U & 255U);
  const auto blue = static_cast<int>(colour & 255U);
  return std::min(red, blue) - green;
}

/// Middle of a cell on the page.
Vector2d pixelOf(const Plot& plot, const GridImage& image, Index i, Index j) {
  const Vector2d cell(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
  return plot.pixel(image.origin + image.cell_size * cell);
}

class Pictures : public TemporaryFolder {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
};

/// Two level terraces, the right one higher, and one unknown cell.
GridImage terraces() {
  GridImage image{ArrayXXd::Zero(40, 20), {100.0, -3.0}, 0.25};
  image.values.bottomRows(20) = 2.0;
  image.values(5, 15) = kNaN;
  return image;
}

TEST_F(Pictures, HeightsAreAPngOfSensibleSize) {
  drawHeights(file("a.png"), "Elevation", terraces(), "height [m]");
  std::ifstream stream(file("a.png"), std::ios::binary);
  std::array<char, 8> signature{};
  stream.read(signature.data(), signature.size());
  EXPECT_EQ(std::string(signature.data(), signature.size()), "\x89PNG\r\n\x1a\n");
  const Png png(file("a.png"));
  EXPECT_GE(png.width(), 900);
  EXPECT_LE(png.width(), 1900);
  EXPECT_GE(png.height(), 450);
  EXPECT_LE(png.height(), 650);
}

TEST_F(Pictures, HeightsHaveTheColourOfTheirValueAndYPointsUp) {
  GridImage image = terraces();
  image.values(30, 2) = kNaN;  // lower right, the other hole is upper left
  drawHeights(file("a.png"), "Elevation", image, "height [m]", ValueRange{-1.0, 3.0});
  const Png png(file("a.png"));
  const Plot plot = mapPlot(image, MapKey::COLOUR_BAR);
  EXPECT_EQ(png.at(pixelOf(plot, image, 10, 4)), rgb(colourAt(heightPalette(), 0.25)));
  EXPECT_EQ(png.at(pixelOf(plot, image, 35, 14)), rgb(colourAt(heightPalette(), 0.75)));
  EXPECT_EQ(png.at(pixelOf(plot, image, 5, 15)), kWhite);
  EXPECT_EQ(png.at(pixelOf(plot, image, 30, 2)), kWhite);
  EXPECT_NE(png.at(pixelOf(plot, image, 30, 17)), kWhite);
}

TEST_F(Pictures, OneScaleForBothAxes) {
  const Plot plot = mapPlot(terraces(), MapKey::COLOUR_BAR);
  EXPECT_DOUBLE_EQ(plot.area.width, 2.0 * plot.area.height);
  EXPECT_DOUBLE_EQ(plot.x.low, 100.0);
  EXPECT_DOUBLE_EQ(plot.x.high, 110.0);
  EXPECT_DOUBLE_EQ(plot.y.low, -3.0);
  EXPECT_DOUBLE_EQ(plot.y.high, 2.0);
}

TEST_F(Pictures, AStepIsLitFromTheUpperLeft) {
  const GridImage image = terraces();  // the step at i = 20 rises towards +x: it faces the light
  drawHeights(file("a.png"), "Elevation", image, "height [m]", ValueRange{-1.0, 3.0});
  const std::uint32_t lit = Png(file("a.png")).at(pixelOf(mapPlot(image, MapKey::COLOUR_BAR), image, 19, 10));
  EXPECT_GT(lit & 255U, rgb(colourAt(heightPalette(), 0.25)) & 255U);
  EXPECT_GT(lit >> 16U, rgb(colourAt(heightPalette(), 0.25)) >> 16U);
}

TEST_F(Pictures, ValuesBeyondTheRangeAreMarkedOnTheBar) {
  GridImage image{ArrayXXd::Zero(30, 30), {0.0, 0.0}, 1.0};
  image.values(3, 3) = 50.0;
  drawHeights(file("within.png"), "", image, "h", ValueRange{-1.0, 100.0});
  drawHeights(file("beyond.png"), "", image, "h", ValueRange{-1.0, 1.0});
  const Plot plot = mapPlot(image, MapKey::COLOUR_BAR);
  const auto bar_pixels_above =
      [&](const std::string& name) {  // the bar starts 20 px below the map's upper edge
        const Png png(file(name));
        int count = 0;
        for (double x = plot.area.right() + 8.0; x < plot.area.right() + 60.0; ++x)
          for (double y = plot.area.y; y < plot.area.y + 17.0; ++y)
            count += difference(png.at({x, y}), rgb(heightPalette().back())) < 4 ? 1 : 0;
        return count;
      };
  EXPECT_EQ(bar_pixels_above("within.png"), 0);
  EXPECT_GT(bar_pixels_above("beyond.png"), 40);
}

TEST_F(Pictures, LabelsAreGreyBlueAndWhite) {
  const GridImage shade{ArrayXXd::Zero(30, 20), {0.0, 0.0}, 0.1};
  ArrayXXi classes = ArrayXXi::Zero(30, 20);
  classes.block(4, 4, 5, 5) = 1;
  classes.block(20, 10, 5, 5) = -1;
  drawLabels(file("a.png"), "Labels", shade, classes, {1234567, 42, 3});
  const Png png(file("a.png"));
  const Plot plot = mapPlot(shade, MapKey::LEGEND);
  const std::uint32_t ground = png.at(pixelOf(plot, shade, 15, 3));
  const std::uint32_t object = png.at(pixelOf(plot, shade, 6, 6));
  EXPECT_EQ(ground & 255U, ground >> 16U);
  EXPECT_NE(ground, kWhite);
  EXPECT_GT(object & 255U, (object >> 16U) + 100U);
  EXPECT_EQ(png.at(pixelOf(plot, shade, 22, 12)), kWhite);
}

TEST_F(Pictures, SegmentsHaveTheirColours) {
  const GridImage shade{ArrayXXd::Zero(40, 40), {0.0, 0.0}, 0.1};
  ArrayXXi segments = ArrayXXi::Zero(40, 40);
  segments.block(2, 2, 12, 12) = 1;
  segments.block(22, 22, 10, 10) = 2;
  segments.block(0, 30, 3, 3) = -1;
  drawSegments(file("a.png"), "Segments", shade, segments, 2);
  const Png png(file("a.png"));
  const Plot plot = mapPlot(shade, MapKey::LEGEND);
  EXPECT_EQ(png.at(pixelOf(plot, shade, 3, 3)), rgb(segmentColour(1)));
  EXPECT_EQ(png.at(pixelOf(plot, shade, 23, 23)), rgb(segmentColour(2)));
  EXPECT_EQ(png.at(pixelOf(plot, shade, 1, 31)), kWhite);
  EXPECT_NE(png.at(pixelOf(plot, shade, 35, 5)), kWhite);
}

TEST_F(Pictures, WhatIsHighAboveGroundIsPale) {
  const GridImage shade{ArrayXXd::Zero(30, 20), {0.0, 0.0}, 0.1};
  ArrayXXi classes = ArrayXXi::Zero(30, 20);
  classes.block(4, 4, 5, 5) = static_cast<int>(CellClass::OBJECT);
  classes.block(20, 10, 5, 5) = static_cast<int>(CellClass::ABOVE_GROUND);
  drawLabels(file("a.png"), "Labels", shade, classes, {});
  ArrayXXi segments = ArrayXXi::Zero(30, 20);
  segments.block(4, 4, 5, 5) = 1;
  segments.block(20, 10, 5, 5) = 2;  // segment 1 of one, above ground
  drawSegments(file("b.png"), "Segments", shade, segments, 1);
  const Plot plot = mapPlot(shade, MapKey::LEGEND);
  const auto blue_less_red = [&](const char* name, Index i, Index j) {
    const std::uint32_t pixel = Png(file(name)).at(pixelOf(plot, shade, i, j));
    return static_cast<int>(pixel & 255U) - static_cast<int>(pixel >> 16U);
  };
  EXPECT_EQ(blue_less_red("a.png", 15, 3), 0);
  EXPECT_GT(blue_less_red("a.png", 22, 12), 20);
  EXPECT_GT(blue_less_red("a.png", 5, 5), blue_less_red("a.png", 22, 12) + 50);
  const Png png(file("b.png"));
  const std::uint32_t ground = png.at(pixelOf(plot, shade, 15, 3)),
                      pale = png.at(pixelOf(plot, shade, 21, 11));
  EXPECT_GT(difference(pale, ground), 10);
  EXPECT_LT(difference(pale, ground), difference(rgb(segmentColour(1)), ground));
}

TEST_F(Pictures, ClassesThatDoNotFitTheShadeAreRefused) {
  const GridImage shade{ArrayXXd::Zero(3, 4), {0.0, 0.0}, 1.0};
  EXPECT_THROW(drawLabels(file("a.png"), "", shade, ArrayXXi::Zero(4, 3), {}), std::invalid_argument);
  EXPECT_THROW(drawSegments(file("a.png"), "", shade, ArrayXXi::Zero(3, 3), 0), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

/// A spectrum falling with frequency, low-passed at the bin (kx, ky) of a 64 x 48 grid.
SpectrumImage slopingSpectrum(int kx, int ky) {
  SpectrumImage image;
  image.before.resize(64, 48);
  image.after.resize(64, 48);
  image.cutoff = std::hypot(2.0 * kx / 64.0, 2.0 * ky / 48.0);
  image.object_size = 2.0 * 0.02 / image.cutoff;
  image.cell_size = 0.02;
  image.peak = Eigen::Vector2i(kx, ky);
  for (Index j = 0; j < 48; ++j)
    for (Index i = 0; i < 64; ++i) {
      const double r = std::hypot(ratioOf(i, 64), ratioOf(j, 48));
      image.before(i, j) = 1.0 / (0.01 + r * r);
      image.after(i, j) = image.before(i, j) / std::sqrt(1.0 + std::pow(r / image.cutoff, 4));
    }
  return image;
}

TEST_F(Pictures, SpectrumMarksTheCutoff) {
  const SpectrumImage image = slopingSpectrum(12, -9);
  drawSpectrum(file("a.png"), image);
  const Png png(file("a.png"));
  EXPECT_EQ(png.width(), 1000);
  for (const SpectrumPanel panel : {SpectrumPanel::BEFORE, SpectrumPanel::AFTER}) {
    const Plot plot = spectrumPlot(image, panel);
    EXPECT_EQ(png.at(plot.pixel({2.0 * 12 / 64, -2.0 * 9 / 48})), kMagenta);  // the star
    EXPECT_LT(magentaOf(png.at(plot.pixel({-2.0 * 12 / 64, 2.0 * 9 / 48}) + Vector2d(0.0, -5.0))), 60);
    EXPECT_GT(magentaOf(png.at(plot.pixel({-image.cutoff, 0.0}))), 80);  // the ellipse
    EXPECT_GT(magentaOf(png.at(plot.pixel({0.0, image.cutoff}))), 80);
    EXPECT_LT(magentaOf(png.at(plot.pixel({0.0, 0.8 * image.cutoff}))), 20);
  }
  const Plot profile = spectrumPlot(image, SpectrumPanel::PROFILE);
  const Vector2d on_line(profile.pixel({image.cutoff, 0.0}).x(), profile.area.bottom() - 5.0);
  EXPECT_GT(magentaOf(png.at(on_line)), 80);
  EXPECT_LT(magentaOf(png.at(on_line + Vector2d(5.0, 0.0))), 20);
}

TEST_F(Pictures, SpectrumIsShiftedAndDarkerAfterTheLowPass) {
  const SpectrumImage image = slopingSpectrum(4, 3);
  drawSpectrum(file("a.png"), image);
  const Png png(file("a.png"));
  const auto green = [&](SpectrumPanel panel, double x, double y) {
    return static_cast<int>(png.at(spectrumPlot(image, panel).pixel({x, y})) >> 8U & 255U);
  };
  const int centre = green(SpectrumPanel::BEFORE, 0.0, 0.0);
  const int corner = green(SpectrumPanel::BEFORE, 0.9, 0.9);
  EXPECT_GT(centre, corner + 40);
  EXPECT_GT(corner, green(SpectrumPanel::AFTER, 0.9, 0.9) + 20);
  EXPECT_EQ(centre, green(SpectrumPanel::AFTER, 0.0, 0.0));
}

TEST_F(Pictures, SpectrumWithoutPeakHasNoStar) {
  SpectrumImage image = slopingSpectrum(12, 9);
  image.peak.reset();
  drawSpectrum(file("a.png"), image);
  const Vector2d star = spectrumPlot(image, SpectrumPanel::AFTER).pixel({2.0 * 12 / 64, 2.0 * 9 / 48});
  EXPECT_LT(magentaOf(Png(file("a.png")).at(star + Vector2d(0.0, -5.0))), 60);
}

TEST(SpectrumRaster, RatiosAreSignedAndWrap) {
  EXPECT_DOUBLE_EQ(ratioOf(0, 8), 0.0);
  EXPECT_DOUBLE_EQ(ratioOf(3, 8), 0.75);
  EXPECT_DOUBLE_EQ(ratioOf(4, 8), -1.0);
  EXPECT_DOUBLE_EQ(ratioOf(-1, 8), ratioOf(7, 8));
  EXPECT_DOUBLE_EQ(ratioOf(3, 7), 6.0 / 7.0);
  EXPECT_DOUBLE_EQ(ratioOf(4, 7), -6.0 / 7.0);
}

TEST(SpectrumRaster, ProfileIsTheMeanPowerOfARing) {
  ArrayXXd magnitudes = ArrayXXd::Constant(32, 32, 0.1);
  magnitudes(0, 0) = 1e6;  // DC is in no ring
  for (const Vector2d& point : radialProfile(magnitudes, {0.05, 1.5, AxisScale::LOGARITHMIC}, 1.0))
    EXPECT_NEAR(point.y(), -20.0, 1e-9) << "at radius " << point.x();
}

TEST(Raster, ReducedMeanIsTheMeanOfKnownCells) {
  ArrayXXd values =
      ArrayXXd::NullaryExpr(7, 5, [](Index i, Index j) { return static_cast<double>(10 * i + j); });
  values(0, 0) = kNaN;
  const ArrayXXd reduced = reducedMean(values, 3, 100);
  ASSERT_EQ(reduced.rows(), 3);
  ASSERT_EQ(reduced.cols(), 5);
  EXPECT_DOUBLE_EQ(reduced(0, 0), 10.0);  // rows 0 and 1, of which 0 is unknown
  EXPECT_DOUBLE_EQ(reduced(0, 1), 6.0);   // (1 + 11) / 2
  EXPECT_DOUBLE_EQ(reduced(2, 4), 54.0);  // (44 + 54 + 64) / 3
  EXPECT_TRUE(std::isnan(reducedMean(ArrayXXd::Constant(4, 4, kNaN), 2, 2)(1, 1)));
}

TEST(Raster, ReducedModeVotesAmongPoints) {
  ArrayXXi classes = ArrayXXi::Constant(4, 2, -1);
  classes(0, 0) = 0;
  classes(2, 0) = 0;
  classes(2, 1) = 1;
  const ArrayXXi reduced = reducedMode(classes, 2, 1);
  EXPECT_EQ(reduced(0, 0), 0);
  EXPECT_EQ(reduced(1, 0), 1);  // of equals the larger
  EXPECT_EQ(reducedMode(ArrayXXi::Constant(4, 2, -1), 2, 1)(0, 0), -1);
}

TEST(Raster, APlaneHasNoShade) {
  const ArrayXXd plane = ArrayXXd::NullaryExpr(
      12, 9, [](Index i, Index j) { return 0.7 * static_cast<double>(i) - 0.3 * static_cast<double>(j); });
  EXPECT_LT(hillShade(plane, {1.0, 1.0}).abs().maxCoeff(), 1e-9);
}

TEST(Raster, RobustRangeIgnoresOutliers) {
  ArrayXXd values = ArrayXXd::NullaryExpr(100, 100, [](Index i, Index) { return static_cast<double>(i); });
  values(0, 0) = 1e9;
  values(1, 0) = -1e9;
  values(2, 0) = kNaN;
  const std::optional<ValueRange> range = robustRange(values);
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->low, 0.0, 1.0);
  EXPECT_NEAR(range->high, 99.0, 1.0);
  EXPECT_FALSE(robustRange(ArrayXXd::Constant(3, 3, kNaN)));
  EXPECT_FALSE(robustRange(ArrayXXd()));
}

TEST(ColourMap, HeightsRiseInLightness) {
  double before = -1.0;
  for (const Colour& colour : heightPalette()) {
    const double luminance = 0.2126 * colour.red + 0.7152 * colour.green + 0.0722 * colour.blue;
    EXPECT_GT(luminance, before - 1e-3);
    before = luminance;
  }
  EXPECT_NE(rgb(colourAt(heightPalette(), kNaN)), rgb(colourAt(heightPalette(), 1.0)));
  EXPECT_EQ(rgb(colourAt(heightPalette(), 1e300)), rgb(heightPalette().back()));
}

TEST(ColourMap, SegmentsInARowAreDistinct) {
  for (int a = 1; a <= 30; ++a)
    for (int b = a + 1; b <= std::min(a + 6, 30); ++b)
      EXPECT_GT(difference(rgb(segmentColour(a)), rgb(segmentColour(b))), 35) << a << " and " << b;
}

TEST(Axes, TicksAreRoundAndInside) {
  const std::vector<Tick> ticks = linearTicks(-0.31, 1.27, 6.0);
  std::vector<std::string> labels;
  for (const Tick& tick : ticks) labels.push_back(tick.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"0.0", "0.5", "1.0"}));
  EXPECT_EQ(linearTicks(1.01, 1.09, 1.0).size(), 1U);  // one at least, however short the axis
  EXPECT_TRUE(linearTicks(2.0, 2.0, 5.0).empty());
  EXPECT_EQ(groupedNumber(1234567), "1,234,567");
  EXPECT_EQ(groupedNumber(-123), "-123");
  EXPECT_EQ(logarithmicTicks(0.015, 0.3, 10.0).front().label, "0.02");
}

/// All five pictures of a grid, whatever is in it.
class DegeneratePictures : public Pictures, public ::testing::WithParamInterface<std::array<Index, 2>> {};

TEST_P(DegeneratePictures, AreDrawn) {
  const auto [width, height] = GetParam();
  for (const double value : {0.0, 1e7, kNaN, std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(value);
    const GridImage image{ArrayXXd::Constant(width, height, value), {5e5, 5e6}, 0.02};
    drawHeights(file("elevation.png"), "Elevation", image, "height [m]");
    drawLabels(file("labels.png"), "Labels", image,
               ArrayXXi::Constant(width, height, std::isnan(value) ? -1 : 1), {});
    drawSegments(file("segments.png"), "Segments", image,
                 ArrayXXi::Constant(width, height, std::isnan(value) ? -1 : 1), 1);
    SpectrumImage spectrum;
    spectrum.before = spectrum.after = image.values;
    spectrum.cutoff = 0.001;
    spectrum.peak = Eigen::Vector2i(0, 0);
    drawSpectrum(file("spectrum.png"), spectrum);
    for (const char* const name : {"elevation.png", "labels.png", "segments.png", "spectrum.png"}) {
      SCOPED_TRACE(name);
      const Png png(file(name));
      EXPECT_GE(png.width(), 400);
      EXPECT_LE(png.width(), 1900);
      EXPECT_GE(png.height(), 100);
      EXPECT_LE(png.height(), 1300);
    }
    const Plot plot = mapPlot(image, MapKey::LEGEND);
    const Vector2d inside =
        plot.area.width > 0.0 ? Vector2d(plot.area.x + 1.0, plot.area.y + 1.0) : Vector2d(0.0, 0.0);
    const bool is_shown = !std::isnan(value) && width * height > 0;
    EXPECT_EQ(Png(file("labels.png")).at(inside) != kWhite, is_shown);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DegeneratePictures,
                         ::testing::Values(std::array<Index, 2>{0, 0}, std::array<Index, 2>{1, 1},
                                           std::array<Index, 2>{1, 3000}, std::array<Index, 2>{3000, 1},
                                           std::array<Index, 2>{0, 900}));

TEST_F(Pictures, AFineGridIsReduced) {
  GridImage image{ArrayXXd::Zero(3000, 2000), {0.0, 0.0}, 0.01};
  image.values.topRows(1500) = 1.0;
  drawHeights(file("a.png"), "Fine", image, "height [m]", ValueRange{0.0, 1.0});
  const Png png(file("a.png"));
  const Plot plot = mapPlot(image, MapKey::COLOUR_BAR);
  EXPECT_LE(png.width(), 1900);
  EXPECT_EQ(png.at(pixelOf(plot, image, 700, 1000)), rgb(heightPalette().back()));
  EXPECT_EQ(png.at(pixelOf(plot, image, 2300, 1000)), rgb(heightPalette().front()));
}

TEST_F(Pictures, OddTitlesDoNotSpoilThePicture) {
  const GridImage image = terraces();
  for (const std::string& title : {std::string("\xff\xfe broken"), std::string(), std::string(5000, 'W')}) {
    drawHeights(file("a.png"), title, image, "height [m]", ValueRange{-1.0, 3.0});
    EXPECT_EQ(Png(file("a.png")).at(pixelOf(mapPlot(image, MapKey::COLOUR_BAR), image, 10, 4)),
              rgb(colourAt(heightPalette(), 0.25)));
  }
}

TEST_F(Pictures, APathThatCannotBeWrittenIsNamed) {
  const std::filesystem::path path = file("missing") / "a.png";
  try {
    drawHeights(path, "Elevation", terraces(), "height [m]");
    FAIL() << "no exception";
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
  EXPECT_THROW(drawSpectrum(path, slopingSpectrum(4, 3)), WorkError);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
