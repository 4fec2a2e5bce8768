#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The formats of cloud files: each decoder takes the whole content of a file and makes a table of its
/// points. All of them throw WorkError of one line that says what is wrong but does not name the file, and
/// allocate nothing for points that the file is too short to hold. PCL's own readers are not used: those of
/// PCL 1.13 allocate whatever a header claims, and crash where the sizes of compressed points lie.
namespace pcl_fft_ground::cli {

/// The formats that are read.
enum class CloudFormat { PCD, PLY, TEXT, LAS, KITTI, NUSCENES };

/// The VIEWPOINT of a PCD file: maps the coordinates of its points to the world. In double, since a place in
/// the world may be millions of metres from its origin.
struct Viewpoint {
  static constexpr double FARTHEST = 1e8;  ///< beyond any coordinates on Earth [m]

  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< of any length above 0

  Eigen::Isometry3d asTransform() const { return Eigen::Translation3d(position) * rotation.normalized(); }
};

/// What the numbers of a label field mean where nobody says so.
enum class LabelScheme {
  OURS,  ///< 0 ground, 1 object, 2 neither
  ASPRS  ///< the classes of LAS: 2 ground; 0, 1, 7, 12 and 18 neither; all others objects
};

/// What a file says, before its coordinates are looked at.
struct RawCloud {
  /// All points and fields, packed; each field of the type that the file gives it.
  pcl::PCLPointCloud2 table;
  Viewpoint viewpoint;
  std::string pose_fault;            ///< why the viewpoint is no pose; empty if it is one
  std::vector<std::string> remarks;  ///< what a user should know of how the file was read
  std::string crs;                   ///< of x and y, as WKT or "EPSG:n"; empty if it is not known
  LabelScheme label_scheme = LabelScheme::OURS;
  bool is_compressed = false;  ///< whether the file is LAZ
  std::vector<bool> withheld;  ///< per point: whether the file asks that it is not used; empty if for none
};

/// The most points that pcl::index_t can count.
constexpr std::int64_t max_point_count = 2147483647;

/// The most bytes that one point may take: far above any real file (a histogram of 10,000 bins has 40,000),
/// and so low that a size times a number of points fits into 64 bits.
constexpr std::uint64_t max_point_bytes = 1u << 24;

/// Checks that a file still holds what its header promises.
/// \param found  bytes after the header
/// \throws WorkError "it is truncated ..."
void requireRoom(std::size_t points, std::size_t needed, std::size_t found);

enum class ByteOrder { LITTLE, BIG };

/** Reads points that stand as records of one size behind one another.
 *
 * \param fields  what to take of each record, with its offset there; the fields of the table, packed
 * \throws WorkError if the bytes do not suffice
 */
pcl::PCLPointCloud2 readRecords(std::string_view bytes, std::size_t record_bytes,
                                const std::vector<pcl::PCLPointField>& fields, std::size_t width,
                                std::size_t height = 1, ByteOrder order = ByteOrder::LITTLE);

/// A field for readRecords().
pcl::PCLPointField recordField(const std::string& name, std::size_t offset, std::uint8_t datatype);

/// A file whose points stand as records of one size behind one another: any part of it can be read by itself.
struct RecordFile {
  std::uint64_t begin = 0;  ///< byte of the first record
  std::size_t record_bytes = 0;
  std::size_t width = 0;  ///< width times height is the number of points
  std::size_t height = 1;
  std::function<RawCloud(std::string_view records)> decode;  ///< of some records, one behind the other
  /// Gives a record another class, one that it has room for; LAS only.
  std::function<void(char* record, int number)> reclassify = nullptr;

  std::size_t points() const { return width * height; }
};

/** How the records of a PCD, PLY or LAS file are read; nothing where its points are no such records (text,
 * compressed, with lists).
 * \param head first bytes of the file, the header and all that stands before the points among them
 * \throws WorkError for a header that is wrong
 */
std::optional<RecordFile> pcdRecords(std::string_view head);
std::optional<RecordFile> plyRecords(std::string_view head);
std::optional<RecordFile> lasRecords(std::string_view head, std::uint64_t file_size);

/// Whether a file's content begins as one of these does.
bool looksLikePcd(std::string_view content);
bool looksLikePly(std::string_view content);
bool looksLikeLas(std::string_view content);

/// Decodes a PCD file of the versions 0.5 to 0.7 (ascii, binary or binary_compressed). The header's lines may
/// come in any order, DATA last. Where they are missing, SIZE is 4, TYPE F, COUNT 1, HEIGHT 1, and WIDTH and
/// POINTS follow from one another. Padding ("_") and fields of COUNT 0 are dropped.
RawCloud decodePcd(std::string_view content);

/// Decodes the vertices of a PLY file (version 1.0; ascii or binary of either byte order) with all their
/// single values; lists and every other element (faces) are passed over. As pcl::PLYReader does, nx, ny, nz
/// become normal_x, normal_y, normal_z; other names stay.
RawCloud decodePly(std::string_view content);

/** Decodes a cloud from text, one point a line.
 *
 * Values are parted by blanks, tabs, commas or semicolons and may stand in quotes; `#` starts a comment;
 * lines without values are passed over; a value with one comma in it (where blanks or semicolons part the
 * values, or in quotes) has a decimal comma. `nan` and `inf` are numbers. Every line has as many values as
 * the first one.
 *
 * In front may stand the number of points and a header, which is a line that does not start with a number, or
 * a comment that names x, y and z. Known names of coordinates, in any order and case and with a unit in
 * brackets behind them, are x, y, z, easting, northing, elevation, lon, lat, height, depth and the like;
 * where they do not name all three, the first three columns are x, y, z, unless one that is named stands
 * elsewhere. A column `label` is the label. The others become float fields called as the header calls them,
 * or `field4`, `field5`
 * ..., NaN where a value is no number. Without a name a fourth and last column is the label if all of its
 * values are 0, 1 or 2.
 */
RawCloud decodeText(std::string_view content);

/** Decodes points of float32 without a header, as the data sets KITTI (x y z intensity) and nuScenes (x y z
 * intensity ring) have them.
 *
 * \param format  KITTI or NUSCENES; nothing: told by the size of the file, and where that fits both by
 * whether the fifth values would be small whole numbers throughout. Then also refuses bytes that are no
 *        coordinates
 */
RawCloud decodeFloats(std::string_view content, std::optional<CloudFormat> format);

/** Decodes a LAS file of the versions 1.0 to 1.4, point formats 0 to 10; a LAZ file, too, where the program
 * is built with LASzip. Coordinates come as FLOAT64; further fields are intensity, return_number,
 * number_of_returns, classification, user_data, scan_angle [degrees], point_source_id and, by format,
 * gps_time, red, green, blue and nir.
 */
RawCloud decodeLas(std::string_view content);

/// The classes that a LAS file gets.
struct LasClasses {
  int ground = 2;
  int object = 1;
  int below = 7;  ///< of objects below the ground
};

/** A LAS file with other classes: the same bytes but for the classification of each point. A LAZ file is
 * compressed anew, and the same bytes when it is unpacked.
 *
 * \param classes  per point, in order: the class, or -1 to leave it as it is
 * \throws WorkError for a file that decodeLas() refuses, or with another number of points, or where its point
 *         format has no room for a class above 31
 */
std::string reclassifiedLas(std::string content, const std::vector<int>& classes);

}  // namespace pcl_fft_ground::cli
