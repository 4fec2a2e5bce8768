// The command on two flight lines of an airborne laser over one town. They are not part of the project:
// without PCL_FFT_GROUND_DATA these tests are skipped.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "command_fixture.h"
#include "commands/commands.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

const Eigen::Vector3d AMID(75, 36, 28);  // of what both lines have seen

/* How line 707 is to be shifted on to 706: the lines are a little apart in the files. By 22 pairs of roof
 * facets, planes fitted by themselves, whose distances one shift explains to 5 mm; its standard deviation is
 * 6 mm.
 */
const Eigen::Vector3d SHIFT_BY_ROOFS(0.062, -0.050, 0.006);

/// An error of the initial guess, amid the scans.
struct GuessError {
  double x, y, turn;  ///< [m, m, degrees]

  Eigen::Isometry3d asTransform() const {
    return Eigen::Translation3d(AMID + Eigen::Vector3d(x, y, 0.1)) *
           Eigen::AngleAxisd(turn * EIGEN_PI / 180, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-AMID);
  }
};

std::ostream& operator<<(std::ostream& out, const GuessError& error) {
  return out << error.x << " m, " << error.y << " m, " << error.turn << " degrees";
}

class FlightLinesTest : public CommandFixture, public testing::WithParamInterface<GuessError> {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    if (std::getenv("PCL_FFT_GROUND_DATA") == nullptr)
      GTEST_SKIP() << "PCL_FFT_GROUND_DATA names no folder of real scans";
  }

  static std::string line(int number) {
    return std::string(std::getenv("PCL_FFT_GROUND_DATA")) + "/strips/ign_dense_urban_strip" +
           std::to_string(number) + ".pcd";
  }

  json align(int reference, int moving) const {
    const Eigen::Isometry3d guess = GetParam().asTransform();
    const Eigen::Vector3d t = guess.translation();
    const std::string words = std::to_string(t.x()) + "," + std::to_string(t.y()) + "," +
                              std::to_string(t.z()) + "," + std::to_string(GetParam().turn);
    return json::parse(run(runAlign, {line(reference), line(moving), "-o", pathOf("pair"), "--guess=" + words,
                                      "--search", "wide", "--max-object-size", "20", "--json"})
                           .out);
  }

  /// Where the middle of the scans is shifted to.
  static Eigen::Vector3d shiftOf(const json& report) {
    Eigen::Isometry3d transform;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) transform.matrix()(i, j) = report["reference_from_moving"][i][j];
    return transform * AMID - AMID;
  }
};

TEST_P(FlightLinesTest, AreAlignedToCentimetresEachWay) {
  const json on_706 = align(706, 707);
  const json on_707 = align(707, 706);
  ASSERT_TRUE(on_706["accepted"]) << on_706;
  ASSERT_TRUE(on_707["accepted"]) << on_707;
  EXPECT_LT((shiftOf(on_706) - SHIFT_BY_ROOFS).norm(), 0.05);
  EXPECT_LT((shiftOf(on_707) + SHIFT_BY_ROOFS).norm(), 0.05);
  EXPECT_LT((shiftOf(on_706) + shiftOf(on_707)).norm(), 0.03) << "one way undoes the other";
}

INSTANTIATE_TEST_SUITE_P(Guesses, FlightLinesTest,
                         testing::Values(GuessError{0, 0, 0}, GuessError{0.9, -0.4, 3},
                                         GuessError{-0.6, 0.8, -3}, GuessError{-0.3, -0.9, 1.5}));

}  // namespace
}  // namespace pcl_fft_ground::cli
