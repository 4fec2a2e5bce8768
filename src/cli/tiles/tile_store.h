#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "pcl_fft_ground/core/scan/points.h"
#include "pcl_fft_ground/core/tiles/tile_ground.h"

/// The files of a run by tiles, which lie in the folder .tiles of the output until it has ended: what one
/// step has made is there whole or not at all, so that a run can be cut off anywhere and goes on from there.
namespace pcl_fft_ground::cli {

/// Numbers as they stand in memory, one behind the other; for files that this machine reads again.
class ByteWriter {
 public:
  template <typename Number>
  void put(const Number& number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  template <typename Number>
  void putAll(const Number* numbers, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
  }
  template <typename Number>
  void putAll(const std::vector<Number>& numbers) {
    put(static_cast<std::uint64_t>(numbers.size()));
    putAll(numbers.data(), numbers.size());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter has written.
class ByteReader {
 public:
  /// \param path named in errors
  ByteReader(std::string bytes, std::string path) : bytes_(std::move(bytes)), path_(std::move(path)) {}

  template <typename Number>
  Number take() {
    Number number{};
    takeAll(&number, 1);
    return number;
  }
  template <typename Number>
  void takeAll(Number* numbers, std::size_t count) {
    require(count * sizeof(Number));
    std::memcpy(numbers, bytes_.data() + place_, count * sizeof(Number));
    place_ += count * sizeof(Number);
  }
  template <typename Number>
  std::vector<Number> takeAll() {
    const auto count = take<std::uint64_t>();
    if (count > bytes_.size()) require(bytes_.size() + 1);
    std::vector<Number> numbers(count);
    takeAll(numbers.data(), count);
    return numbers;
  }

 private:
  void require(std::size_t bytes) const;  // throws WorkError if they are not there

  std::string bytes_, path_;
  std::size_t place_ = 0;
};

/// The folder of such files.
class TileStore {
 public:
  explicit TileStore(const std::string& output_directory);

  const std::string& folder() const { return folder_; }
  std::string path(std::size_t tile, const char* kind) const;
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  bool has(std::size_t tile, const char* kind) const;

  /// Makes the folder, empty.
  void begin() const;
  /// Removes the folder and all that is in it.
  void remove() const;

  /// Writes a file with a sum by which a damaged one is recognised, whole or not at all.
  void write(const std::string& file, const ByteWriter& content) const;
  /// \throws WorkError naming the file if it is not there as it was written
  ByteReader read(const std::string& file) const;

  /// The points of a file of nothing but coordinates. \param expected number of points
  /// \throws WorkError naming the file if it holds another number
  core::Points readPoints(std::size_t tile, const char* kind, std::size_t expected) const;

 private:
  std::string folder_;
};

/// Appends records to many files, few of which are open at a time.
class ManyFiles {
 public:
  /// \param memory bytes that may wait for being written, in all
  ManyFiles(std::vector<std::string> paths, std::size_t memory);

  void append(std::size_t file, const void* bytes, std::size_t count);

  /// Writes what waits. \throws WorkError naming the file
  void flush();

 private:
  void flush(std::size_t file);

  std::vector<std::string> paths_, waiting_;
  std::size_t most_;
};

void putGround(const core::TileGround& ground, ByteWriter& writer);
core::TileGround takeGround(ByteReader& reader);

}  // namespace pcl_fft_ground::cli
