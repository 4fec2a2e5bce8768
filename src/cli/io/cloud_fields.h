#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/pcl_config.h>
#include <pcl/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_fft_ground::cli {

/// Field types that PCL has names for from 1.13 on only.
constexpr std::uint8_t INT64_FIELD = 9;
constexpr std::uint8_t UINT64_FIELD = 10;
constexpr std::uint8_t BOOL_FIELD = 11;
#if PCL_VERSION_COMPARE(>=, 1, 13, 0)
static_assert(INT64_FIELD == pcl::PCLPointField::INT64, "as in PCL");
static_assert(UINT64_FIELD == pcl::PCLPointField::UINT64, "as in PCL");
static_assert(BOOL_FIELD == pcl::PCLPointField::BOOL, "as in PCL");
#endif

/// Points in a cloud of any layout.
inline std::size_t pointCount(const pcl::PCLPointCloud2& cloud) {
  return static_cast<std::size_t>(cloud.width) * cloud.height;
}

/// Bytes of one value of a field type (pcl::PCLPointField::PointFieldTypes).
/// \throws std::invalid_argument for a number that is no field type
std::size_t valueSize(std::uint8_t datatype);

/// Bytes that a field takes of each point.
std::size_t fieldSize(const pcl::PCLPointField& field);

/// Appends a field to the layout behind all others, without padding. The data are not touched: this is for
/// building the layout of a cloud that has none yet.
void appendField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype,
                 std::uint32_t count);

/// Sets width and height and makes room for the points, all bytes zero.
void allocatePoints(pcl::PCLPointCloud2& cloud, std::size_t width, std::size_t height);

/// The first field of a name, or null.
const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, std::string_view name);

/// Whether a field of this name, in any case, says what each point is: label, class, classification, or one
/// of these as CloudCompare writes them.
bool isLabelName(std::string_view name);

/// The field `label`, else the first one with another name that isLabelName(), of one value a point; or null.
const pcl::PCLPointField* findLabelField(const pcl::PCLPointCloud2& cloud);

/// The stored value of a field type as a double; `bytes` need not be aligned.
double loadNumber(const std::uint8_t* bytes, std::uint8_t datatype);

/// Stores the number that `text` spells as a value of a field type.
/// \return false, and nothing stored, if it spells no number or one that the type cannot hold
bool storeNumber(std::string_view text, std::uint8_t datatype, std::uint8_t* bytes);

/// The first value of a field for every point, in input order.
std::vector<double> fieldNumbers(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field);

/// Renames the first field called `from`; does nothing if there is none. No field is lost: one that is
/// already called `to` becomes `to_2` (or the first number that is free).
void renameField(pcl::PCLPointCloud2& cloud, const std::string& from, const std::string& to);

/// Appends an int32 field with one value per point; a field that already has this name is replaced.
/// \throws std::invalid_argument if there is not one value for each point
void setInt32Field(pcl::PCLPointCloud2& cloud, const std::string& name,
                   const std::vector<std::int32_t>& values);

/// The same with float32 values.
void setFloatField(pcl::PCLPointCloud2& cloud, const std::string& name, const std::vector<float>& values);

/// The points of the given indices, in their order, with all their fields (height 1, padding dropped).
/// \throws std::out_of_range for an index outside the cloud
pcl::PCLPointCloud2 selectPoints(const pcl::PCLPointCloud2& cloud, const pcl::Indices& indices);

}  // namespace pcl_fft_ground::cli
