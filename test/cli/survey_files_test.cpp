#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "commands/survey/survey_pairs.h"
#include "commands/survey/survey_report.h"
#include "errors.h"
#include "io/pose_table.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {
namespace {

using core::PairKind;
using core::PairResult;
using core::PairStatus;

class SurveyFiles : public TemporaryFolder {};

Eigen::Isometry3d somePose() {
  return Eigen::Translation3d(1.25, -2.5, 0.125) *
         Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.1, -0.2, 0.9).normalized());
}

PairResult someResult() {
  PairResult result;
  result.method = "fft+dense";
  result.kind = PairKind::OTHER;
  result.reference = 1;
  result.moving = 0;
  result.status = PairStatus::REFUSED;
  result.refusal = "a reason, with a comma and \"quotes\"";
  result.matches = 7;
  result.score = 0.75;
  result.overlap = 0.375;
  result.nx_before = 123456;
  result.nx_after = 123000;
  result.crispness_after = 1.5;
  result.rotation_error = 0.0625;
  result.seconds = 0.5;
  result.reference_from_moving = somePose();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) result.covariance(i, j) = 1e-6 * (1 + i * j);
  return result;
}

TEST_F(SurveyFiles, PosesAreReadAsTheyWereWritten) {
  const std::string path =
      makeFile("poses.csv", asCsv({{"a.pcd", somePose()}, {"b.pcd", somePose().inverse()}}));
  const std::vector<NamedPose> poses = readPoses(path);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].submap, "b.pcd");
  EXPECT_TRUE(poses[0].world_from_submap.isApprox(somePose(), 1e-10));
  EXPECT_TRUE(poses[1].world_from_submap.isApprox(somePose().inverse(), 1e-10));
}

TEST_F(SurveyFiles, PosesMayHaveLineEndsOfWindows) {
  const std::string path = makeFile("poses.csv", "submap,x,y,z,qx,qy,qz,qw\r\na.pcd,1,2,3,0,0,0,1\r\n");
  const std::vector<NamedPose> poses = readPoses(path);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].world_from_submap.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(SurveyFiles, DamagedPosesAreRefusedNamingTheFile) {
  const std::string header = "submap,x,y,z,qx,qy,qz,qw\n";
  for (const std::string& content : {std::string("x,y\n"), header + "a,1,2,3\n",
                                     header + "a,1,2,3,0,0,0,zero\n", header + "a,1,2,3,0,0,0,0\n"}) {
    SCOPED_TRACE(content);
    const std::string path = makeFile("poses.csv", content);
    try {
      readPoses(path);
      ADD_FAILURE() << "not refused";
    } catch (const WorkError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
  }
  EXPECT_THROW(readPoses(pathOf("missing.csv")), WorkError);
}

TEST_F(SurveyFiles, PairsAreReadAsTheyWereWritten) {
  const std::vector<std::string> names = {"a.pcd", "b.pcd"};
  const PairResult given = someResult();
  const std::string text = asCsv({given, PairResult()}, names);
  const std::vector<PairResult> read = readPairs(makeFile("pairs.csv", text), names);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(asCsv(read, names), text);
  EXPECT_EQ(read[0].refusal, given.refusal);
  EXPECT_EQ(read[0].reference, 1u);
  EXPECT_EQ(read[0].kind, PairKind::OTHER);
  EXPECT_EQ(read[0].status, PairStatus::REFUSED);
  EXPECT_FALSE(read[0].crispness_before);
  EXPECT_EQ(read[0].crispness_after, given.crispness_after);
  EXPECT_TRUE(read[0].reference_from_moving.isApprox(somePose(), 1e-10));
  EXPECT_TRUE(read[0].covariance.isApprox(given.covariance, 1e-10));
}

TEST_F(SurveyFiles, AnEmptyFileHoldsNoPairs) {
  EXPECT_TRUE(readPairs(makeFile("pairs.csv", ""), {"a.pcd", "b.pcd"}).empty());
  EXPECT_THROW(readPairs(pathOf("missing.csv"), {"a.pcd", "b.pcd"}), WorkError);
}

TEST_F(SurveyFiles, DamagedPairsAreRefusedNamingTheFile) {
  const std::string text = asCsv({someResult()}, {"a.pcd", "b.pcd"});
  const std::string path = makeFile("pairs.csv", text);
  EXPECT_THROW(readPairs(path, {"a.pcd", "other.pcd"}), WorkError);
  makeFile("pairs.csv", text.substr(0, text.size() / 2 + 200));
  EXPECT_THROW(readPairs(path, {"a.pcd", "b.pcd"}), WorkError);
  makeFile("pairs.csv", "method\n");
  EXPECT_THROW(readPairs(path, {"a.pcd", "b.pcd"}), WorkError);
}

TEST_F(SurveyFiles, AJournalThatWasCutOffWithinALineHasTheLinesBeforeIt) {
  const std::vector<std::string> names = {"a.pcd", "b.pcd"};
  const nlohmann::ordered_json parameters{{"version", "1"}};
  const std::string journal = pathOf("pairs.journal");
  PairResult first = someResult(), second = first;
  second.method = "other";
  SurveyRecord(pathOf(""), parameters, names, std::nullopt).add(first);
  const std::string whole = contentOf(journal);
  SurveyRecord(pathOf(""), parameters, names, std::nullopt).add(second);
  EXPECT_EQ(contentOf(journal).rfind(whole, 0), 0U);
  makeFile("pairs.journal", whole + whole.substr(whole.find('\n') + 1, 100));  // as a kill leaves it
  SurveyRecord record(pathOf(""), parameters, names, std::nullopt);
  ASSERT_NE(record.find(first.method, {first.reference, first.moving}), nullptr);
  EXPECT_EQ(record.find("other", {first.reference, first.moving}), nullptr);
  record.add(second);
  record.finish({first, second});
  EXPECT_FALSE(std::filesystem::exists(journal));
  EXPECT_EQ(contentOf(pathOf("pairs.csv")), asCsv({first, second}, names));
}

TEST_F(SurveyFiles, TheLastRunHasWhatTheShardsFound) {
  const std::vector<std::string> names = {"a.pcd", "b.pcd"};
  const nlohmann::ordered_json parameters{{"version", "1"}};
  PairResult first = someResult(), second = first;
  second.method = "other";
  SurveyRecord one(pathOf(""), parameters, names, Shard{1, 2}),
      two(pathOf(""), parameters, names, Shard{2, 2});
  one.add(first);
  two.add(second);
  SurveyRecord all(pathOf(""), parameters, names, std::nullopt);
  EXPECT_NE(all.find(first.method, {first.reference, first.moving}), nullptr);
  EXPECT_NE(all.find("other", {first.reference, first.moving}), nullptr);
  const nlohmann::ordered_json others{{"version", "2"}};
  EXPECT_EQ(
      SurveyRecord(pathOf(""), others, names, std::nullopt).find("other", {first.reference, first.moving}),
      nullptr);
}

TEST(SurveyReport, PrintsTheColumnsOfThePaperAndNanWithoutAlignments) {
  PairResult crisper, never;
  crisper.method = "fft";
  crisper.status = PairStatus::ALIGNED;
  crisper.overlap = 0.4;
  crisper.nx_before = 1000;
  crisper.nx_after = 800;
  never.method = "graph-cut";
  never.status = PairStatus::NOT_RUN;
  never.refusal = "not run: too many cells";
  std::ostringstream out;
  printTables(out, {crisper, never});
  for (const char* text : {"mean dNx [%]", "std dNx [%]", "dNx > 0", "dNx = 0", "dNx < 0", "unprocessed",
                           "-25.00", "Nan", "1/1", "not run: too many cells"})
    EXPECT_NE(out.str().find(text), std::string::npos) << text;
}

TEST(SegmenterOf, TakesTheFallbackOff) {
  EXPECT_EQ(segmenterOf("fft"), "fft");
  EXPECT_EQ(segmenterOf("fft+dense"), "fft");
  EXPECT_EQ(segmenterOf("dense-icp"), "dense-icp");
  EXPECT_EQ(segmenterOf("+dense"), "+dense");
}

}  // namespace
}  // namespace pcl_fft_ground::cli
