#include "pcl_fft_ground/core/survey/survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pcl_fft_ground::core {
namespace {

/// Standard deviations of the world's making [m], [rad].
struct Noise {
  double navigation = 0.1;
  double edge = 0.002;
};

/** A field of square scans, 4 m wide, 3 m apart, run to and fro; what an alignment of two would say is the
 * truth with some noise.
 */
class Field {
 public:
  Field(int columns, int rows, const Noise& noise = {}) : noise_(noise) {
    for (int row = 0; row < rows; ++row)
      for (int n = 0; n < columns; ++n) add(row % 2 == 0 ? n : columns - 1 - n, row);
  }

  const std::vector<SurveyScan>& scans() const { return scans_; }
  const std::vector<Eigen::Isometry3d>& truth() const { return truth_; }

  PairResult align(const PlannedPair& pair) {
    PairResult result;
    result.kind = pair.kind;
    result.reference = pair.scans.reference;
    result.moving = pair.scans.moving;
    result.status = PairStatus::ALIGNED;
    result.reference_from_moving = Eigen::Translation3d(noise_.edge * drawn(), noise_.edge * drawn(), 0) *
                                   truth_[result.reference].inverse() * truth_[result.moving];
    result.covariance.diagonal().setConstant(noise_.edge * noise_.edge);
    return result;
  }

 private:
  double drawn() { return normal_(random_); }

  void add(int column, int row) {
    truth_.push_back(Eigen::Translation3d(3.0 * column, 3.0 * row, 0) *
                     Eigen::AngleAxisd(row % 2 == 0 ? 0 : EIGEN_PI, Eigen::Vector3d::UnitZ()));
    const Eigen::Isometry3d navigation =
        Eigen::Translation3d(noise_.navigation * drawn(), noise_.navigation * drawn(), 0) * truth_.back() *
        Eigen::AngleAxisd(0.01 * drawn(), Eigen::Vector3d::UnitZ());
    scans_.push_back({navigation, Eigen::Vector3d::Zero(), squareCoverage(), {}});
  }

  static ScanCoverage squareCoverage() {
    constexpr int CELLS = 20;
    ScanCoverage coverage;
    coverage.geometry.origin = {-2, -2};
    coverage.geometry.rows = coverage.geometry.cols = CELLS;
    coverage.geometry.cell_size = 0.2;
    coverage.depth = Eigen::ArrayXXf::Constant(CELLS, CELLS, 1.0F);
    return coverage;
  }

  Noise noise_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
  std::vector<SurveyScan> scans_;
  std::vector<Eigen::Isometry3d> truth_;
};

TEST(Survey, PairsAreTheChainAndAllOthersThatOverlap) {
  const Field field(3, 2, {0, 0});
  const std::vector<PlannedPair> pairs = planPairs(field.scans());
  std::size_t chain = 0;
  for (const PlannedPair& pair : pairs) chain += pair.kind == PairKind::CHAIN ? 1 : 0;
  EXPECT_EQ(chain, 6u);
  // 4 m squares 3 m apart share a quarter with each of four neighbours, a sixteenth over the corners.
  EXPECT_EQ(pairs.size(), 7u);
}

TEST(Survey, ErrorsAreThoseOfTheMovedCentroid) {
  Field field(2, 1);
  PairResult result = field.align({{0, 1}, PairKind::CHAIN});
  const Eigen::Isometry3d true_pair = field.truth()[0].inverse() * field.truth()[1];
  result.reference_from_moving = Eigen::Translation3d(0.03, 0, 0.04) * true_pair *
                                 Eigen::AngleAxisd(EIGEN_PI / 180, Eigen::Vector3d::UnitX());
  const PairResult judged = withErrors(result, field.scans(), field.truth());
  EXPECT_NEAR(*judged.translation_error, 0.05, 1e-12);
  EXPECT_NEAR(*judged.rotation_error, 1, 1e-9);
  EXPECT_NEAR(judged.overlap, 0.25, 0.051);
}

TEST(Survey, PoseErrorsDoNotSeeWhereTheWholeLies) {
  const Field field(3, 2);
  const Eigen::Isometry3d anywhere =
      Eigen::Translation3d(70, -3, 1) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized());
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& pose : field.truth()) poses.push_back(anywhere * pose);
  EXPECT_LT(poseErrors(field.scans(), field.truth(), poses).max_translation, 1e-9);
  poses[2] = poses[2] * Eigen::Translation3d(0, 0, 0.5);
  EXPECT_GT(poseErrors(field.scans(), field.truth(), poses).max_translation, 0.2);
}

TEST(Survey, PooledErrorsAreThoseOfAllScans) {
  const PoseErrors all = pooled({{1, 0.3, 0.4, 1}, {3, 0.1, 0.2, 2}, {4, 0, 0, 5}});
  EXPECT_EQ(all.scans, 8u);
  EXPECT_NEAR(all.rms_translation, std::sqrt((0.09 + 3 * 0.01) / 8), 1e-12);
  EXPECT_EQ(all.max_translation, 0.4);
  EXPECT_EQ(all.median_rotation, 2);
}

TEST(Survey, TrustHasToBeAboveZero) {
  NavigationSigmas sigmas;
  validate(sigmas);
  sigmas.tilt = 0;
  EXPECT_THROW(validate(sigmas), std::invalid_argument);
}

TEST(SurveyUnderWay, ANewcomerIsNoMoreWorkInALargeSurvey) {
  Field field(20, 15);
  std::vector<PairResult> results;
  std::vector<Eigen::Isometry3d> poses;
  for (const SurveyScan& scan : field.scans()) poses.push_back(scan.world_from_scan);
  std::size_t most = 0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const std::vector<PlannedPair> pairs = pairsOfNewcomer(n, field.scans(), poses);
    for (const PlannedPair& pair : pairs) results.push_back(field.align(pair));
    most = std::max(most, pairs.size());
    const std::vector<Eigen::Isometry3d> refined = refineAround(n, field.scans(), results, poses).poses;
    std::size_t moved = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) moved += refined[k].isApprox(poses[k], 0) ? 0 : 1;
    EXPECT_LE(moved, 25u) << "five rows and columns about the newcomer hold no more";
    poses = refined;
  }
  EXPECT_LE(most, 6u);
  EXPECT_LT(poseErrors(field.scans(), field.truth(), poses).rms_translation, 0.05);
  const SurveyPoses solved = solveSurvey(field.scans(), results, "");
  EXPECT_LT(poseErrors(field.scans(), field.truth(), solved.global).rms_translation, 0.01);
}

TEST(SurveyUnderWay, AnEdgeThatDoesNotFitIsTold) {
  Field field(2, 2);
  const std::vector<Eigen::Isometry3d>& poses = field.truth();
  std::vector<PairResult> results = {field.align({{0, 1}, PairKind::CHAIN}),
                                     field.align({{1, 2}, PairKind::CHAIN}),
                                     field.align({{2, 3}, PairKind::CHAIN})};
  EXPECT_FALSE(refineAround(3, field.scans(), results, poses).contradicted);
  results.push_back(field.align({{0, 3}, PairKind::OTHER}));
  results.back().reference_from_moving.translation().x() += 1;
  EXPECT_TRUE(refineAround(3, field.scans(), results, poses).contradicted);
}

}  // namespace
}  // namespace pcl_fft_ground::core
