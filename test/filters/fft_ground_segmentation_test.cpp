#include "pcl_fft_ground/fft_ground_segmentation.h"

#include <gtest/gtest.h>
#include <pcl/exceptions.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "clouds.h"
#include "low_pass_segmentation.h"
#include "output_capture.h"

namespace pcl_fft_ground::test {
namespace {

using Point = pcl::PointXYZ;
using Segmenter = FFTGroundSegmentation<Point>;

/// A segmenter that knows the largest object of boxScene(), with an input.
Segmenter segmenterOn(const pcl::PointCloud<Point>::ConstPtr& cloud) {
  Segmenter segmenter;
  segmenter.setMaximumObjectSize(0.8);
  segmenter.setInputCloud(cloud);
  return segmenter;
}

Segmenter segmenterOnBoxes() {
  return segmenterOn(cloudOf<Point>(boxScene().points));
}

pcl::Indices objectsOf(Segmenter& segmenter) {
  pcl::PointIndices ground, objects;
  segmenter.segment(ground, objects);
  return objects.indices;
}

TEST(FFTGroundSegmentation, DefaultsAreOfTheRobustEstimator) {
  const Segmenter segmenter;
  EXPECT_EQ(segmenter.getEstimator(), Estimator::ROBUST);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::AUTO);
  EXPECT_EQ(segmenter.getRelativeMaximumObjectSize(), 0.5);
  EXPECT_EQ(segmenter.getMaximumSlope(), 0.0);
  EXPECT_EQ(segmenter.getCellStatistic(), CellStatistic::LOWEST);
  for (const double chosen_later : {segmenter.getCellSize(), segmenter.getHeightTolerance(),
                                    segmenter.getFinestWavelength(), segmenter.getGroundSpread()})
    EXPECT_TRUE(std::isnan(chosen_later));
  EXPECT_TRUE(segmenter.getChoices().empty());
  EXPECT_TRUE(segmenter.getHeightAboveGround().empty());
}

TEST(FFTGroundSegmentation, TheEstimatorDecidesAboutUpUnlessItIsSet) {
  Segmenter segmenter;
  segmenter.setEstimator(Estimator::LOW_PASS);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::PRINCIPAL_AXIS);
  segmenter.setEstimator(Estimator::ROBUST);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::AUTO);
  segmenter.setUpEstimation(UpEstimation::GIVEN);
  segmenter.setEstimator(Estimator::LOW_PASS);
  EXPECT_EQ(segmenter.getUpEstimation(), UpEstimation::GIVEN);
  Segmenter copy(segmenter);
  copy.setEstimator(Estimator::ROBUST);
  EXPECT_EQ(copy.getUpEstimation(), UpEstimation::GIVEN);
}

TEST(FFTGroundSegmentation, RobustSettersReadBackAndRejectInvalidValues) {
  Segmenter segmenter;
  segmenter.setCellSize(0.5);
  segmenter.setHeightTolerance(0.25);
  segmenter.setFinestWavelength(2);
  segmenter.setMaximumSlope(0.3);
  segmenter.setCellStatistic(CellStatistic::MEAN);
  EXPECT_EQ(segmenter.getCellSize(), 0.5);
  EXPECT_EQ(segmenter.getHeightTolerance(), 0.25);
  EXPECT_EQ(segmenter.getFinestWavelength(), 2.0);
  EXPECT_EQ(segmenter.getCellStatistic(), CellStatistic::MEAN);
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double v : {-0.1, nan, infinity}) {
    EXPECT_THROW(segmenter.setMaximumSlope(v), pcl::PCLException) << v;
    EXPECT_THROW(segmenter.setFinestWavelength(v), pcl::PCLException) << v;
  }
  EXPECT_THROW(segmenter.setFinestWavelength(0), pcl::PCLException);
  EXPECT_EQ(segmenter.getMaximumSlope(), 0.3);
  segmenter.setMaximumSlope(0);  // none
  EXPECT_EQ(segmenter.getMaximumSlope(), 0.0);
}

TEST(FFTGroundSegmentation, FindsTheBoxesByTheirSizeAlone) {
  const Scene scene = boxScene();
  Segmenter segmenter = segmenterOnBoxes();
  std::vector<bool> flags(scene.is_object.size(), false);
  for (const pcl::index_t i : objectsOf(segmenter)) flags[static_cast<std::size_t>(i)] = true;
  EXPECT_EQ(flags, scene.is_object);
  EXPECT_TRUE(segmenter.getWarnings().empty());
}

TEST(FFTGroundSegmentation, WhatIsNotSetIsChosenAndReported) {
  Segmenter segmenter = segmenterOnBoxes();
  objectsOf(segmenter);
  EXPECT_GT(segmenter.getCellSize(), 0.0);
  EXPECT_LT(segmenter.getCellSize(), 0.8);
  EXPECT_GT(segmenter.getHeightTolerance(), 0.0);
  EXPECT_LT(segmenter.getHeightTolerance(), 0.3);
  EXPECT_GT(segmenter.getFinestWavelength(), 0.0);
  EXPECT_GE(segmenter.getGroundSpread(), 0.0);
  const std::size_t by_data = segmenter.getChoices().size();
  for (const core::RobustChoice& choice : segmenter.getChoices()) EXPECT_FALSE(choice.reason.empty());
  segmenter.setCellSize(0.05);
  segmenter.setHeightTolerance(0.1);
  objectsOf(segmenter);
  EXPECT_EQ(segmenter.getElevationGrid().geometry.cell_size, 0.05);
  EXPECT_EQ(segmenter.getHeightTolerance(), 0.1);
  EXPECT_EQ(segmenter.getChoices().size() + 2, by_data);
}

TEST(FFTGroundSegmentation, SpectrumIsThatOfTheElevationAndOfTheGround) {
  Segmenter segmenter = segmenterOnBoxes();
  objectsOf(segmenter);
  const auto expectMean = [](const core::Spectrum& spectrum, const Eigen::ArrayXXd& grid) {
    ASSERT_EQ(spectrum.rows, grid.rows());
    EXPECT_NEAR(spectrum.half(0, 0).real(), grid.sum(), 1e-9);
    const double energy = core::magnitude(spectrum).square().sum() / static_cast<double>(grid.size());
    EXPECT_NEAR(energy, grid.square().sum(), 1e-9);
  };
  expectMean(segmenter.getSpectrum(), segmenter.getElevationGrid().elevation);
  expectMean(segmenter.getFilteredSpectrum(), segmenter.getGroundSurface().height);
  EXPECT_EQ(segmenter.getCutoff().source, core::CutoffSource::FINEST_WAVELENGTH);
  EXPECT_NEAR(segmenter.getCutoff().object_size, segmenter.getFinestWavelength(), 1e-9);
  EXPECT_FALSE(segmenter.getSpectrumPeaks().empty());
}

TEST(FFTGroundSegmentation, ACutoffFrequencyIsForTheOtherEstimator) {
  Segmenter segmenter = segmenterOnBoxes();
  segmenter.setCutoffFrequency(0.25);
  const OutputCapture capture;
  objectsOf(segmenter);
  ASSERT_EQ(segmenter.getWarnings().size(), 1U);
  EXPECT_NE(segmenter.getWarnings()[0].find("cut-off"), std::string::npos);
}

TEST(FFTGroundSegmentation, HeightsAboveTheGroundFollowTheInput) {
  const auto cloud = cloudOf<Point>(boxScene().points);
  spoilPoints(*cloud);
  Segmenter segmenter = segmenterOn(cloud);
  objectsOf(segmenter);
  const std::vector<double> all = segmenter.getHeightAboveGround();
  ASSERT_EQ(all.size(), cloud->size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    const Eigen::Vector3d p = (*cloud)[n].getVector3fMap().cast<double>();
    ASSERT_EQ(std::isnan(all[n]), !p.allFinite()) << n;
    if (p.allFinite()) {
      EXPECT_EQ(all[n], segmenter.getGroundSurface().heightAbove(p)) << n;
    }
  }
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{700, 3}));
  const std::vector<double> two = segmenter.getHeightAboveGround();
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0], all[700]);
  EXPECT_EQ(two[1], all[3]);
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  EXPECT_TRUE(segmenter.getHeightAboveGround().empty());
}

TEST(FFTGroundSegmentation, ProbabilitiesOfTheGroundFollowTheInput) {
  const auto cloud = cloudOf<Point>(boxScene().points);
  spoilPoints(*cloud);
  Segmenter segmenter = segmenterOn(cloud);
  EXPECT_TRUE(segmenter.getGroundProbability().empty());
  objectsOf(segmenter);
  const std::vector<float> all = segmenter.getGroundProbability();
  ASSERT_EQ(all.size(), cloud->size());
  const std::vector<double> heights = segmenter.getHeightAboveGround();
  double on_ground = 0, on_object = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    ASSERT_EQ(std::isnan(all[n]), std::isnan(heights[n])) << n;
    if (std::isnan(all[n])) continue;
    ASSERT_TRUE(all[n] >= 0 && all[n] <= 1) << all[n];
    if (heights[n] > 3 * segmenter.getHeightTolerance()) on_object = std::max(on_object, 1.0 * all[n]);
    if (std::abs(heights[n]) < segmenter.getGroundSpread()) on_ground += all[n] < 0.5F ? 1 : 0;
  }
  EXPECT_LT(on_object, 0.05);
  EXPECT_EQ(on_ground, 0);
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{700, 3}));
  EXPECT_EQ(segmenter.getGroundProbability(), (std::vector<float>{all[700], all[3]}));
  segmenter.setIndices(pcl::IndicesPtr(new pcl::Indices{-1}));
  EXPECT_TRUE(segmenter.getGroundProbability().empty());
  Segmenter published = segmenterOn(cloud);
  published.setEstimator(Estimator::LOW_PASS);
  objectsOf(published);
  EXPECT_TRUE(published.getGroundProbability().empty());
}

TEST(FFTGroundSegmentation, APointDeepBelowIsAnObjectAndCounted) {
  const auto cloud = cloudOf<Point>(boxScene().points);
  (*cloud)[2000].z -= 3;
  cloud->height = 1;
  cloud->width = static_cast<std::uint32_t>(cloud->size());
  Segmenter segmenter = segmenterOn(cloud);
  const pcl::Indices objects = objectsOf(segmenter);
  EXPECT_EQ(segmenter.getPointsBelowGround() + segmenter.getFarPoints().size(), 1U);
  EXPECT_EQ(std::count(objects.begin(), objects.end(), 2000), 1);
}

TEST(FFTGroundSegmentation, TheNumberOfThreadsDoesNotMatter) {
  // So many points, each a little aside of the last time, that there is something to share.
  const auto cloud = cloudOf<Point>(boxScene().points);
  const std::size_t once = cloud->size();
  for (int k = 1; cloud->size() < 150000; ++k)
    for (std::size_t n = 0; n < once; ++n) {
      Point p = (*cloud)[n];
      p.x += 1e-4F * static_cast<float>(k);
      cloud->push_back(p);
    }
  for (const Estimator estimator : {Estimator::ROBUST, Estimator::LOW_PASS}) {
    SCOPED_TRACE(estimator == Estimator::ROBUST ? "robust" : "low-pass");
    Segmenter segmenter = segmenterOn(cloud);
    segmenter.setEstimator(estimator);
    EXPECT_EQ(segmenter.getNumberOfThreads(), 1U);
    const pcl::Indices objects = objectsOf(segmenter);
    EXPECT_FALSE(objects.empty());
    const Eigen::ArrayXXd surface = segmenter.getGroundSurface().height;
    for (const unsigned threads : {2U, 3U, 8U, 0U}) {
      segmenter.setNumberOfThreads(threads);
      EXPECT_EQ(Segmenter(segmenter).getNumberOfThreads(), threads);
      EXPECT_EQ(objectsOf(segmenter), objects) << threads;
      EXPECT_TRUE((segmenter.getGroundSurface().height == surface).all()) << threads;
    }
  }
}

}  // namespace
}  // namespace pcl_fft_ground::test
