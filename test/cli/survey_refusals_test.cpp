// What the commands `survey` and `align` refuse, and what they explain.

#include "commands/commands.h"
#include "errors.h"
#include "survey_fixture.h"

namespace pcl_fft_ground::cli {
namespace {

class SurveyRefusals : public SurveyFixture {
 protected:
  Printed survey(const Words& more = {}) const { return run(runSurvey, with({site_, "-o", output()}, more)); }
};

TEST_F(SurveyRefusals, RefusesFoldersThatWouldBeMixedUp) {
  const std::vector<std::pair<Words, std::string>> wrong = {
      {{site_, site_ + "/.", "-o", output()}, "same name"},
      {{site_, "-o", site_}, "among the sub-maps"},
      {{site_, copyOfTwo("other"), "-o", folder_.string()}, "among the sub-maps"}};
  for (const auto& [words, named] : wrong) {
    try {
      run(runSurvey, words);
      ADD_FAILURE() << "not refused: " << named;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
    EXPECT_FALSE(hasOutput());
  }
}

TEST_F(SurveyRefusals, RefusesNamesThatWouldBreakItsTables) {
  const std::string folder = copyOfTwo("other");
  std::filesystem::rename(folder + "/submap_01.pcd", folder + "/a,1.pcd");
  try {
    run(runSurvey, {folder, "-o", output()});
    ADD_FAILURE() << "not refused";
  } catch (const WorkError& error) {
    EXPECT_NE(std::string(error.what()).find("a,1.pcd"), std::string::npos) << error.what();
  }
}

TEST_F(SurveyRefusals, HelpTellsWhatThereIs) {
  EXPECT_NE(run(runSurvey, {"--help"}).out.find("Table II"), std::string::npos);
  EXPECT_NE(run(runAlign, {"--help"}).out.find("transform.txt"), std::string::npos);
  EXPECT_NE(run(runSimulate, {"survey", "--help"}).out.find("truth.csv"), std::string::npos);
}

TEST_F(SurveyRefusals, RefusesFoldersWithoutASurvey) {
  makeFile("one.pcd", "");
  for (const std::string& folder : {pathOf("missing"), folder_.string()}) {
    try {
      run(runSurvey, {folder, "-o", output()});
      ADD_FAILURE() << "not refused";
    } catch (const WorkError& error) {
      EXPECT_NE(std::string(error.what()).find(folder), std::string::npos);
    }
  }
}

TEST_F(SurveyRefusals, WrongUsageNamesTheOptionAndWhatIsAllowed) {
  const std::vector<std::pair<Words, std::string>> wrong = {
      {{"--methods", "fft,magic"}, "magic"},       {{"--min-matches", "0"}, "--min-matches"},
      {{"--min-score", "2"}, "--min-score"},       {{"--max-turn", "200"}, "180"},
      {{"--search", "far"}, "navigation or wide"}, {{"--matching", "best"}, "local or plain"},
      {{"--fallback", "yes"}, "dense or none"},    {{"--heading-sigma", "0"}, "--heading-sigma"},
      {{"--voxel-size", "nan"}, "--voxel-size"},   {{"--navigation-sigma", "1e-300"}, "0.0001"}};
  for (const auto& [words, named] : wrong) {
    SCOPED_TRACE(words[0]);
    try {
      survey(words);
      ADD_FAILURE() << "not refused";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
    EXPECT_FALSE(hasOutput());
  }
  EXPECT_THROW(run(runAlign, {submap(0), submap(1), "-o", output(), "--guess", "1,2,3"}), UsageError);
  EXPECT_THROW(run(runAlign, {submap(0), "-o", output()}), UsageError);
  EXPECT_THROW(run(runAlign, {submap(0), submap(1)}), UsageError);
  EXPECT_THROW(run(runSurvey, {"-o", output()}), UsageError);
  EXPECT_THROW(run(runSurvey, {"", "-o", output()}), UsageError);
  EXPECT_THROW(run(runSimulate, {"survey", "reef", "-o", output()}), UsageError);
  EXPECT_THROW(run(runSimulate, {"survey", "wreck", "-o", output(), "--noise", "9"}), UsageError);
}

}  // namespace
}  // namespace pcl_fft_ground::cli
