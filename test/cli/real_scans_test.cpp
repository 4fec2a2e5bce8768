// The command on real scans. They are not part of the project: without PCL_FFT_GROUND_DATA these tests are
// skipped.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::json;

/// A scan and the parameters of its family; F1 of the published method lies between the two bounds.
struct RealScan {
  std::string file, cell_size, max_object_size;
  double least_f1 = 0, most_f1 = 1;
};

std::ostream& operator<<(std::ostream& out, const RealScan& scan) {
  return out << scan.file;
}

class RealScanTest : public CommandFixture, public testing::WithParamInterface<RealScan> {};

TEST_P(RealScanTest, IsSegmented) {
  const char* const folder = std::getenv("PCL_FFT_GROUND_DATA");
  if (folder == nullptr) GTEST_SKIP() << "PCL_FFT_GROUND_DATA names no folder of real scans";
  const RealScan& scan = GetParam();
  const std::string output = pathOf("result");
  const json report =
      json::parse(run(runSegment, {std::string(folder) + "/" + scan.file, "-o", output, "--cell-size",
                                   scan.cell_size, "--max-object-size", scan.max_object_size, "--json"})
                      .out);
  const json& counts = report["counts"];
  EXPECT_EQ(counts["ground"].get<int>() + counts["objects"].get<int>() + counts["neither"].get<int>(),
            counts["points"]);
  EXPECT_GT(counts["ground"], 0);
  EXPECT_GT(counts["objects"], 0);
  EXPECT_LE(report["spectrum"]["object_size"].get<double>(), std::stod(scan.max_object_size));
  for (const char* name :
       {"labelled.pcd", "ground_surface.asc", "segments.csv", "spectrum.png", "segments.png"})
    EXPECT_TRUE(std::filesystem::exists(output + "/" + name)) << name;
  if (report["scores"].is_null()) return;
  EXPECT_GE(report["scores"]["f1"].get<double>(), scan.least_f1);
  EXPECT_LE(report["scores"]["f1"].get<double>(), scan.most_f1);
}

// Where the published method fails, the test holds it to failing as measured: better would be another method.
INSTANTIATE_TEST_SUITE_P(Families, RealScanTest,
                         testing::Values(RealScan{"underwater/reef_horseshoe_1cm.pcd", "0.02", "2.5"},
                                         RealScan{"mosd/mosd_learn0.pcd", "0.01", "0.4", 0.35, 0.5},
                                         RealScan{"oakland/oakland_part2_ac.pcd", "0.5", "10", 0.3, 0.5},
                                         RealScan{"isprs/isprs_samp31.pcd", "1", "40", 0.7, 0.85},
                                         RealScan{"underwater/laparguera_slope.pcd", "20", "200"}));

}  // namespace
}  // namespace pcl_fft_ground::cli
