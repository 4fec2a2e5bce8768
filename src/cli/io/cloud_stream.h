#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "io/cloud_file.h"
#include "io/formats.h"

namespace pcl_fft_ground::cli {

/// A cloud file that is read part by part and never held whole: binary PCD or PLY, or LAS.
class CloudStream {
 public:
  /// \throws WorkError naming the file: for one that readCloud() refuses by its header, and for one whose
  ///         points are no records of one size (text, compressed)
  CloudStream(const std::string& path, const ReadOptions& options);

  const std::string& path() const { return path_; }
  CloudFormat format() const { return format_; }
  const RecordFile& records() const { return records_; }
  std::size_t points() const { return records_.points(); }

  /// Size of the file and when it was last written, as text: it tells whether the file has changed.
  const std::string& stamp() const { return stamp_; }

  std::uint64_t fileSize() const { return size_; }  ///< [bytes]

  /// Some bytes of the file. \throws WorkError naming the file
  std::string bytes(std::uint64_t first, std::size_t count);

  /// Some of the points, as the file has them. \throws WorkError naming the file
  RawCloud read(std::size_t first, std::size_t count);

 private:
  std::string path_;
  CloudFormat format_ = CloudFormat::PCD;
  RecordFile records_;
  std::string stamp_;
  std::uint64_t size_ = 0;
  std::ifstream stream_;
};

/// How many points a cloud file holds and the bytes of each, as far as that is known without reading it.
struct CloudSize {
  std::size_t points = 0;
  std::size_t record_bytes = 0;
};

/// \return nothing for a file that is no stream, or that cannot be read at all
std::optional<CloudSize> sizeOfCloud(const std::string& path, const ReadOptions& options);

}  // namespace pcl_fft_ground::cli
