// Any bytes as a cloud file: it is read, or refused with a WorkError.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "errors.h"
#include "io/cloud_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path =
      std::filesystem::temp_directory_path() / ("cloud_file_fuzzer." + std::to_string(getpid()));
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  using pcl_fft_ground::cli::CloudFormat;
  // By content, and as if the user had named each format.
  const std::optional<CloudFormat> formats[] = {std::nullopt,         CloudFormat::PCD, CloudFormat::PLY,
                                                CloudFormat::TEXT,    CloudFormat::LAS, CloudFormat::KITTI,
                                                CloudFormat::NUSCENES};
  for (const auto& format : formats) {
    try {
      pcl_fft_ground::cli::readCloud(path, {format, {}, {}});
    } catch (const pcl_fft_ground::cli::WorkError&) {
      // as promised
    }
  }
  std::filesystem::remove(path);
  return 0;
}
