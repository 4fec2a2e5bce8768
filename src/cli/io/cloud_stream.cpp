#include "io/cloud_stream.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "errors.h"
#include "io/cloud_parts.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr std::uint64_t HEAD_BYTES = 1 << 20;  // enough for any header but that of a LAS file with much in it

std::string readHead(std::ifstream& stream, std::uint64_t bytes) {
  std::string head(bytes, '\0');
  stream.clear();
  stream.seekg(0);
  stream.read(head.data(), static_cast<std::streamsize>(bytes));
  if (!stream) throw WorkError("it could not be read");
  return head;
}

std::optional<RecordFile> recordsOf(CloudFormat format, std::ifstream& stream, const std::string& head,
                                    std::uint64_t size) {
  switch (format) {
    case CloudFormat::PCD:
      return pcdRecords(head);
    case CloudFormat::PLY:
      return plyRecords(head);
    case CloudFormat::LAS: {
      const std::optional<RecordFile> records = lasRecords(head, size);
      const bool is_longer = records && records->begin > head.size() && records->begin <= size;
      return is_longer ? lasRecords(readHead(stream, records->begin), size) : records;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace

CloudStream::CloudStream(const std::string& path, const ReadOptions& options) : path_(path) {
  try {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) throw WorkError(std::strerror(errno));
    if (!S_ISREG(status.st_mode)) throw WorkError("it is not a regular file");
    stream_.open(path, std::ios::binary);
    if (!stream_) throw WorkError(std::strerror(errno));
    const std::uint64_t size = size_ = static_cast<std::uint64_t>(status.st_size);
    if (size == 0) throw WorkError("it is empty");
    stamp_ = std::to_string(size) + " bytes of " + std::to_string(status.st_mtim.tv_sec) + "." +
             std::to_string(status.st_mtim.tv_nsec);
    const std::string head = readHead(stream_, std::min(size, HEAD_BYTES));
    format_ = formatOf(path, head, options);
    std::optional<RecordFile> records = recordsOf(format_, stream_, head, size);
    if (!records)
      throw WorkError("only binary PCD, binary PLY and LAS can be read in parts, as --tile asks for");
    if (records->points() == 0) throw WorkError("it holds no points");
    requireRoom(records->points(), records->points() * records->record_bytes,
                size - std::min(size, records->begin));
    records_ = std::move(*records);
  } catch (const WorkError& error) {
    throw WorkError("cannot read '" + path + "': " + error.what());
  }
}

std::string CloudStream::bytes(std::uint64_t first, std::size_t count) {
  std::string result(count, '\0');
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(first));
  stream_.read(result.data(), static_cast<std::streamsize>(count));
  if (!stream_) throw WorkError("cannot read '" + path_ + "': it ends before its last point");
  return result;
}

RawCloud CloudStream::read(std::size_t first, std::size_t count) {
  return records_.decode(
      bytes(records_.begin + first * records_.record_bytes, count * records_.record_bytes));
}

std::optional<CloudSize> sizeOfCloud(const std::string& path, const ReadOptions& options) {
  try {
    const CloudStream stream(path, options);
    return CloudSize{stream.points(), stream.records().record_bytes};
  } catch (const WorkError&) {
    return std::nullopt;
  }
}

}  // namespace pcl_fft_ground::cli
