#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

/// What stands around the points of a LAS file, compressed or not.
namespace pcl_fft_ground::cli {

/// How a LAZ file becomes one of LAS without this program.
constexpr const char* UNPACK_LAZ =
    "convert it by 'laszip -i IN.laz -o OUT.las', 'las2las' or 'pdal translate IN.laz OUT.las'";

/// A number at a place of a file, least byte first; the caller has checked that it is there.
template <typename Number>
Number numberAt(std::string_view content, std::size_t place) {
  Number number{};
  std::memcpy(&number, content.data() + place, sizeof number);
  return number;
}

/// What is needed of a LAS file's header, checked against the size of the file.
struct LasHeader {
  std::size_t header_bytes = 0;
  unsigned minor = 0;       ///< of the version 1.0 to 1.4
  std::uint8_t format = 0;  ///< of a point, 0 to 10
  bool is_compressed = false;
  std::size_t record_bytes = 0;  ///< of a point, unpacked
  std::size_t points_begin = 0;
  std::size_t points = 0;  ///< as the header counts them; what is compressed may hold fewer
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::string remark;  ///< on a count that is below what the file has; empty if there is none

  /// Whether a record has room for 256 classes.
  bool isNewFormat() const { return format >= 6; }
  std::size_t classPlace() const { return isNewFormat() ? 16 : 15; }
  bool isWithheld(std::string_view record) const {
    const auto flags = static_cast<std::uint8_t>(record[15]);
    return (flags & (isNewFormat() ? 0x04U : 0x80U)) != 0;
  }
};

/// \param content the first bytes of a file of `file_size` bytes, or all of it
/// \throws WorkError for a header that is wrong or counts more than the file has room for
LasHeader parseLasHeader(std::string_view content, std::uint64_t file_size);

enum class RecordKind {
  PLAIN,    ///< VLR, in front of the points
  EXTENDED  ///< EVLR, behind them
};

/// A variable length record.
struct VariableRecord {
  std::string_view user;  ///< who defines it
  std::uint16_t id = 0;
  std::string_view data;
  std::string_view whole;  ///< with its header
};

/// The records from a place on; fewer than `count` where the next one does not fit into the content.
std::vector<VariableRecord> variableRecords(std::string_view content, std::size_t begin, std::uint64_t count,
                                            RecordKind kind);

/** A LAZ file unpacked: the bytes of the LAS file that was compressed, without the records that tell of the
 * compression (LASzip's and those of COPC).
 *
 * \throws WorkError where it is damaged, and always if this program is built without LASzip
 */
std::string unpackedLas(std::string_view laz);

/// A LAS file compressed, as unpackedLas() unpacks it. \throws WorkError as unpackedLas()
std::string packedLas(std::string_view las);

}  // namespace pcl_fft_ground::cli
