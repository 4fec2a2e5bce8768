#include <limits>

#include "command_fixture.h"
#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

/// What `segment` must not do, and what it must survive.
class SegmentRefusals : public CommandFixture {
 protected:
  /// The one-line message of the error that the command must end in, having printed and written nothing.
  template <typename Error>
  std::string errorOf(const Words& words) const {
    const StreamText out(std::cout), err(std::cerr);
    std::string message;
    try {
      runSegment(words);
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(out.str() + err.str(), "");
    EXPECT_FALSE(hasOutput());
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  /// The cloud ends in a WorkError that names its file.
  void expectNoWork(const std::string& path) const {
    SCOPED_TRACE(path);
    const auto message = errorOf<WorkError>({path, "-o", output(), "--cell-size", "0.04"});
    EXPECT_NE(message.find(path), std::string::npos) << message;
  }

  std::string makePoints(const std::string& name, const std::vector<Eigen::Vector3f>& points) const {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    for (const Eigen::Vector3f& p : points) cloud.push_back({p.x(), p.y(), p.z()});
    return makeCloud(name, cloud);
  }
};

TEST_F(SegmentRefusals, FilesThatHoldNoCloud) {
  expectNoWork(pathOf("missing.pcd"));
  expectNoWork(folder_.string());
  expectNoWork(makeFile("empty.pcd", ""));
  expectNoWork(makeFile("empty.ply", ""));
  expectNoWork(makeFile("empty.xyz", ""));
  expectNoWork(makeFile("truncated.pcd", contentOf(makeScan()).substr(0, 60000)));
  expectNoWork(makeFile("header.pcd", contentOf(makeScan()).substr(0, 40)));
  expectNoWork(makeFile("words.xyz", "these are\nno numbers\n"));
  pcl::PointCloud<pcl::Intensity> no_coordinates(5, 1);
  expectNoWork(makeCloud("no_coordinates.pcd", no_coordinates));
}

TEST_F(SegmentRefusals, CloudsWithoutAFinitePoint) {
  expectNoWork(makePoints("none.pcd", {}));
  expectNoWork(makePoints("nan.pcd", {{NOT_A_NUMBER, 0, 0}, {0, 0, NOT_A_NUMBER}}));
}

TEST_F(SegmentRefusals, GridsWithTooManyCells) {
  const std::string scan = makeScan();
  for (const char* cell_size : {"1e-9", "1e-300", "1e-4"}) {
    const auto message = errorOf<WorkError>({scan, "-o", output(), "--cell-size", cell_size});
    EXPECT_NE(message.find(scan), std::string::npos) << message;
    EXPECT_NE(message.find("1e+08 cells"), std::string::npos) << message;
  }
  std::vector<Eigen::Vector3f> huge;
  for (int n = 0; n < 100; ++n)
    huge.emplace_back(1e30f * static_cast<float>(n % 10), 1e30f * static_cast<float>(n / 10), 0.f);
  expectNoWork(makePoints("huge.pcd", huge));
}

TEST_F(SegmentRefusals, OutputsThatAreNoPlaceForADirectory) {
  const std::string scan = makeScan(), file = makeFile("file", "kept");
  for (const std::string& place : {file, file + "/below", std::string("/dev/null")}) {
    const auto message = errorOf<WorkError>({scan, "-o", place, "--cell-size", "0.04"});
    EXPECT_NE(message.find("'" + place + "'"), std::string::npos) << message;
  }
  EXPECT_EQ(contentOf(file), "kept");
  EXPECT_EQ(names().size(), 2u);
}

TEST_F(SegmentRefusals, ADirectoryThatMayNotBeWritten) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const std::string scan = makeScan();
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const auto message = errorOf<WorkError>({scan, "-o", pathOf("locked"), "--cell-size", "0.04"});
  EXPECT_NE(message.find(pathOf("locked")), std::string::npos) << message;
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_all);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "locked"));
}

TEST_F(SegmentRefusals, CallsWithoutACloudOrAnOutput) {
  const std::string scan = makeScan();
  EXPECT_NE(errorOf<UsageError>({}).find("no cloud"), std::string::npos);
  EXPECT_NE(errorOf<UsageError>({"-o", output()}).find("no cloud"), std::string::npos);
  EXPECT_NE(errorOf<UsageError>({"", "-o", output()}).find("no cloud"), std::string::npos);
  EXPECT_NE(errorOf<UsageError>({scan}).find("-o DIR"), std::string::npos);
  EXPECT_NE(errorOf<UsageError>({scan, "-o", ""}).find("-o DIR"), std::string::npos);
}

/// Options that are refused, and what the message has to name: the option, the value, what is allowed.
struct Refused {
  Words options;
  Words named;
};

class SegmentRefusesValue : public SegmentRefusals, public ::testing::WithParamInterface<Refused> {};

TEST_P(SegmentRefusesValue, NamingOptionValueAndRange) {
  Words words{makeScan(), "-o", output()};
  words.insert(words.end(), GetParam().options.begin(), GetParam().options.end());
  const auto message = errorOf<UsageError>(words);
  EXPECT_NE(message.find(GetParam().options.front()), std::string::npos) << message;
  for (const std::string& name : GetParam().named)
    EXPECT_NE(message.find(name), std::string::npos) << message;
  EXPECT_EQ(message.find("FFTGround"), std::string::npos) << message;  // a class means nothing to a user
}

INSTANTIATE_TEST_SUITE_P(
    Segment, SegmentRefusesValue,
    ::testing::Values(Refused{{"--cell-size", "0"}, {" 0", "metres above 0"}},
                      Refused{{"--cell-size", "-0.02"}, {"-0.02", "metres above 0"}},
                      Refused{{"--cell-size", "nan"}, {"nan", "metres above 0"}},
                      Refused{{"--cell-size", "inf"}, {"inf", "metres above 0"}},
                      Refused{{"--max-object-size", "0"}, {" 0", "metres above 0"}},
                      Refused{{"--max-object-size", "nan"}, {"nan", "metres above 0"}},
                      Refused{{"--relative-max-object-size", "0"}, {" 0", "(0, 1]"}},
                      Refused{{"--relative-max-object-size", "1.5"}, {"1.5", "(0, 1]"}},
                      Refused{{"--relative-max-object-size", "-0.5"}, {"-0.5", "(0, 1]"}},
                      Refused{{"--relative-max-object-size", "nan"}, {"nan", "(0, 1]"}},
                      Refused{{"--max-object-size", "1", "--relative-max-object-size", "0.5"},
                              {"--relative-max-object-size", "one of the two"}},
                      Refused{{"--height-tolerance", "-inf"}, {"-inf", "finite"}},
                      Refused{{"--up-direction", "0", "0", "0"}, {"0", "above 0"}},
                      Refused{{"--up-direction", "0", "0", "1m"}, {"1m", "three numbers"}},
                      Refused{{"--up-direction", "0", "0", "--json"}, {"three numbers"}},
                      Refused{{"--sensor", "0", "0", "up"}, {"up", "three numbers"}},
                      Refused{{"--sensor", "0", "nan", "0"}, {"nan", "finite"}},
                      Refused{{"--sensor", "0", "0"}, {"three numbers"}},
                      Refused{{"--up-estimation", "down"}, {"down", "auto", "principal-axis", "given"}},
                      Refused{{"--yaw", "north"}, {"north", "min-area-rectangle", "principal-axes", "none"}},
                      Refused{{"--method", "magic"}, {"magic", "fft-lowpass"}},
                      Refused{{"--cutoff-frequency", "1.5"}, {"1.5", "1.41421"}},
                      Refused{{"--cutoff-frequency", "-0.1"}, {"-0.1", "1.41421"}},
                      Refused{{"--filter-order", "0"}, {" 0", "[1, 100]"}},
                      Refused{{"--filter-order", "-1"}, {"-1", "whole number"}},
                      Refused{{"--passband-ripple", "0"}, {" 0", "(0, 100]"}},
                      Refused{{"--max-slope", "-0.1"}, {"-0.1", "at least 0"}},
                      Refused{{"--finest-wavelength", "0"}, {" 0", "above 0"}},
                      Refused{{"--estimator", "fast"}, {"fast", "robust, low-pass"}},
                      Refused{{"--cell-statistic", "median"}, {"median", "lowest, mean"}},
                      Refused{{"--peak-window", "0"}, {" 0", "[1, 1000]"}},
                      Refused{{"--peak-window", "-1"}, {"-1", "whole number"}},
                      Refused{{"--peak-threshold", "-1"}, {"-1", "at least 0"}},
                      Refused{{"--leaf-size", "0"}, {" 0", "above 0"}},
                      Refused{{"--leaf-size", "-1e-9"}, {"-1e-09", "above 0"}},
                      Refused{{"--leaf-size", "nan"}, {"nan", "above 0"}},
                      Refused{{"--clusters", "heaps"}, {"heaps", "objects or contact"}},
                      Refused{{"--min-object-size", "0"}, {" 0", "above 0"}},
                      Refused{{"--min-object-size", "inf"}, {"inf", "above 0"}},
                      Refused{{"--min-cluster-size", "0"}, {" 0", "from 1"}},
                      Refused{{"--min-cluster-size", "5000000000"}, {"5000000000", "2147483647"}},
                      Refused{{"--max-cluster-size", "5", "--min-cluster-size", "20"},
                              {"5", "--min-cluster-size", "20"}}));

/// Odd clouds that hold at least one finite point: no error, and every point gets a label.
class SegmentSurvives : public SegmentRefusals {
 protected:
  void expectLabels(const std::string& name, const std::vector<Eigen::Vector3f>& points,
                    const char* cell_size = "0.04") const {
    SCOPED_TRACE(name);
    run(runSegment, {makePoints(name, points), "-o", output(), "--cell-size", cell_size});
    EXPECT_EQ(valuesOf(readByPcl(outputOf("labelled.pcd")), "label"),
              std::vector<double>(points.size(), 0.0));
    EXPECT_TRUE(std::filesystem::exists(outputOf("segments.png")));
    std::filesystem::remove_all(output());
  }
};

TEST_F(SegmentSurvives, FewPoints) {
  expectLabels("one.pcd", {{1, 2, 3}});
  expectLabels("equal.pcd", {{1, 2, 3}, {1, 2, 3}});
}

TEST_F(SegmentSurvives, PointsOfOneLine) {
  std::vector<Eigen::Vector3f> line;
  for (int n = 0; n < 50; ++n) line.emplace_back(0.05f * static_cast<float>(n), 0.f, 0.f);
  expectLabels("line.pcd", line);
}

TEST_F(SegmentSurvives, ACellLargerThanTheScan) {
  const std::string scan = makeScan();
  run(runSegment, {scan, "-o", output(), "--cell-size", "1e30"});
  EXPECT_EQ(valuesOf(readByPcl(outputOf("labelled.pcd")), "label").size(), 10000u);
}

TEST_F(SegmentSurvives, AnElongatedScan) {
  pcl::PointCloud<pcl::PointXYZL> cloud = boxScan();
  for (pcl::PointXYZL& p : cloud) p.x *= 4;
  segment(makeCloud("long.pcd", cloud));
  EXPECT_EQ(valuesOf(readByPcl(outputOf("labelled.pcd")), "label").size(), 10000u);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
