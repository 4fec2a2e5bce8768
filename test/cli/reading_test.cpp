// What the commands make of files: labels of other meanings, poses that are none, formats told by the user.

#include <pcl/io/pcd_io.h>

#include "commands/survey/survey_scans.h"
#include "errors.h"
#include "las_bytes.h"
#include "segment_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

class Reading : public SegmentCommand {
 protected:
  /// The box scan as text with a word for each ground point and one for each point of the box.
  std::string makeText(const std::string& header, const std::string& ground, const std::string& box) const {
    std::ostringstream text;
    text << header;
    for (const pcl::PointXYZL& p : boxScan())
      text << p.x << ' ' << p.y << ' ' << p.z << ' ' << (p.label == 0 ? ground : box) << '\n';
    return makeFile("scan.txt", text.str());
  }

  /// A PCD file with this VIEWPOINT and nothing else special.
  std::string makePosed(const std::string& name, const std::string& viewpoint) const {
    std::ostringstream text;
    text << "FIELDS x y z\nVIEWPOINT " << viewpoint << "\nPOINTS 10000\nDATA ascii\n";
    for (const pcl::PointXYZL& p : boxScan()) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
    return makeFile(name, text.str());
  }

  template <typename Command>
  static std::string errorOf(const Command& command, const Words& words) {
    try {
      run(command, words);
    } catch (const WorkError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(Reading, UnknownLabelsHaveNoScoresAndOneLine) {
  const std::string scan = makeText("x y z label\n", "40", "50");
  const Printed printed = segment(scan);
  EXPECT_EQ(printed.out.find("tpr"), std::string::npos) << printed.out;
  EXPECT_NE(printed.err.find("its labels are 40, 50: no scores"), std::string::npos) << printed.err;
  EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1);
  EXPECT_TRUE(report()["scores"].is_null());
  EXPECT_EQ(report()["warnings"].size(), 1u);
  const Printed told = segment(scan, {"--ground-classes", "40"});
  EXPECT_NE(told.out.find("tpr 1"), std::string::npos) << told.out;
  EXPECT_EQ(told.err, "");
  EXPECT_EQ(report()["parameters"]["ground-classes"]["value"], json::array({40}));
  const Printed ignored = segment(scan, {"--ground-classes", "40", "--ignore-classes", "50"});
  EXPECT_EQ(ignored.out.find("tpr"), std::string::npos) << ignored.out;
  EXPECT_NE(ignored.out.find("tnr"), std::string::npos) << ignored.out;
}

TEST_F(Reading, ColumnsThatAreNoLabelsAreKept) {
  const Printed printed = segment(makeText("", "0", "37"));
  EXPECT_EQ(printed.out.find("tpr"), std::string::npos) << printed.out;
  EXPECT_EQ(printed.err, "");
  const std::vector<double> kept = valuesOf(readByPcl(outputOf("labelled.pcd")), "field4");
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 37), 15 * 15);
}

TEST_F(Reading, EvaluateTakesTheSameWords) {
  const std::string scan = makeText("x y z label\n", "40", "50");
  const Words words{scan, "--methods", "fft", "--cell-size", "0.04", "--max-object-size", "0.6"};
  EXPECT_NE(errorOf(runEvaluate, words).find("its labels are 40, 50"), std::string::npos);
  Words told = words;
  told.insert(told.end(), {"--ground-classes", "40,44,48", "--json"});
  EXPECT_EQ(json::parse(run(runEvaluate, told).out)["results"][0]["tpr"], 1);
  told.insert(told.end(), {"--ignore-classes", "4O"});
  EXPECT_THROW(run(runEvaluate, told), UsageError);
}

TEST_F(Reading, AQuaternionOfZerosIsNoPose) {
  const std::string bad = makePosed("bad.pcd", "1 2 3 0 0 0 0"),
                    good = makePosed("good.pcd", "1 2 3 1 0 0 0");
  const Printed printed = segment(bad);
  EXPECT_NE(printed.err.find("quaternion of zeros"), std::string::npos) << printed.err;
  EXPECT_EQ(segment(good).err, "");
  EXPECT_NE(errorOf(runAlign, {good, bad, "-o", pathOf("pair")}).find("bad.pcd: its VIEWPOINT"),
            std::string::npos);
  EXPECT_NE(errorOf(runSurvey, {folder_.string(), "-o", pathOf("site")}).find("bad.pcd: its VIEWPOINT"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(pathOf("pair")));
}

TEST_F(Reading, FoldersGiveTheirCloudsInAnyCase) {
  for (const char* name : {"a.pcd", "b.PCD", "c.Ply", "d.LAS", "e.txt", ".f.pcd"}) makeFile(name, "");
  const Words found = listSubmaps(folder_.string());
  Words file_names;
  for (const std::string& path : found) file_names.push_back(std::filesystem::path(path).filename().string());
  EXPECT_EQ(file_names, (Words{"a.pcd", "b.PCD", "c.Ply", "d.LAS"}));
}

TEST_F(Reading, TheFormatCanBeTold) {
  std::string points;
  for (const pcl::PointXYZL& p : boxScan())
    points.append(reinterpret_cast<const char*>(p.data), 4 * sizeof(float));
  const std::string path = makeFile("points.dat", points);
  EXPECT_THROW(segment(path), WorkError);
  segment(path, {"--format", "kitti"});
  const std::vector<double> label = labels();
  EXPECT_NEAR(static_cast<double>(std::count(label.begin(), label.end(), 1)), 15 * 15, 30);
  EXPECT_THROW(segment(path, {"--format", "e57"}), UsageError);
  const std::string las = makeFile("scan.las", lasFile());
  EXPECT_NE(errorOf(runAlign, {las, las, "-o", pathOf("pair"), "--format", "ply"}).find("no PLY file"),
            std::string::npos);
}

/// Why clouds are not read by PCL: its own reader leaves coordinates of doubles out without an error, and
/// keeps seven digits of a place in the world.
TEST_F(Reading, KeepsWhatPclsReaderLoses) {
  const std::string path = makeFile(
      "utm.pcd",
      "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nVIEWPOINT 6000000.12345 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n"
      "499999.125 5412345.25 -30\n");
  const Cloud ours = readCloud(path);
  EXPECT_EQ((*ours.points)[0].getVector3fMap().cast<double>() + ours.origin,
            Eigen::Vector3d(499999.125, 5412345.25, -30));
  EXPECT_EQ(ours.viewpoint.position.x() - ours.origin.x(), 6000000.12345);
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile(path, theirs), 0);
  EXPECT_NE(theirs[0].y, 5412345.25f);
  EXPECT_NE(static_cast<double>(theirs.sensor_origin_.x()), 6000000.12345);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
