#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_fft_ground::cli {

/// A new folder, which nobody removes by itself; empty if it could not be made.
inline std::string makeTemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "pcl_fft_ground_XXXXXX").string();
  return mkdtemp(pattern.data()) != nullptr ? pattern : std::string();
}

/// A fixture with a folder of its own that is removed after the test.
class TemporaryFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = makeTemporaryFolder();
    ASSERT_FALSE(folder_.empty());
  }

  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string pathOf(const std::string& name) const { return (folder_ / name).string(); }

  /// Makes a file of these bytes and returns its path.
  std::string makeFile(const std::string& name, std::string_view content) const {
    std::ofstream(pathOf(name), std::ios::binary) << content;
    return pathOf(name);
  }

  static std::string contentOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  /// Names of all that is in the folder, hidden files too.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      result.push_back(entry.path().filename().string());
    }
    return result;
  }

  std::filesystem::path folder_;
};

}  // namespace pcl_fft_ground::cli
