#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "command_fixture.h"
#include "commands/commands.h"
#include "io/cloud_file.h"
#include "io/pose_table.h"

namespace pcl_fft_ground::cli {

/// A survey of the first four sub-maps along a transect of a pipe field, made once for all suites of the
/// program, which leave it as it is.
class SurveyFixture : public CommandFixture {
 protected:
  static void SetUpTestSuite() {
    static const struct Site {
      const std::string folder = makeTemporaryFolder();
      ~Site() {
        if (!folder.empty()) std::filesystem::remove_all(folder);
      }
    } site;
    if (!site_.empty()) return;
    ASSERT_FALSE(site.folder.empty());
    run(runSimulate, {"survey", "pipes", "-o", site.folder, "--points", "60000", "--seed", "1"});
    for (int i = 4; i < 26; ++i)
      std::filesystem::remove(site.folder + (i < 10 ? "/submap_0" : "/submap_") + std::to_string(i) + ".pcd");
    site_ = site.folder;
  }

  static std::string submap(int i) { return site_ + "/submap_0" + std::to_string(i) + ".pcd"; }
  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// A folder with the first two sub-maps only.
  std::string copyOfTwo(const std::string& name) const {
    std::filesystem::create_directory(pathOf(name));
    for (const char* file : {"/submap_00.pcd", "/submap_01.pcd", "/truth.csv"})
      std::filesystem::copy_file(site_ + file, pathOf(name) + file);
    return pathOf(name);
  }

  /// A PCD file with one more field, which has no values.
  static std::string withEmptyField(std::string pcd) {
    for (const auto& [line, more] :
         {std::pair{"FIELDS", " empty"}, {"SIZE", " 4"}, {"TYPE", " F"}, {"COUNT", " 0"}})
      pcd.insert(pcd.find('\n', pcd.find(std::string("\n") + line) + 1), more);
    return pcd;
  }

  /// Every other point of a sub-map in other coordinates, in double, and without a VIEWPOINT.
  void makeMoved(const std::string& name, const Cloud& cloud,
                 const Eigen::Isometry3d& file_from_points) const {
    std::ostringstream text;
    text << std::setprecision(12);
    for (std::size_t n = 0; n < cloud.points->size(); n += 2) {
      const Eigen::Vector3d place = file_from_points * (*cloud.points)[n].getVector3fMap().cast<double>();
      text << place.x() << ' ' << place.y() << ' ' << place.z() << '\n';
    }
    const std::string count = std::to_string((cloud.points->size() + 1) / 2);
    makeFile(name, "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH " + count + "\nHEIGHT 1\nDATA ascii\n" +
                       text.str());
  }

  static inline std::string site_;
};

}  // namespace pcl_fft_ground::cli
