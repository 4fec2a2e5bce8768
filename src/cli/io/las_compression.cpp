// LAZ, by LASzip where the program is built with it.
#include "errors.h"
#include "io/las_header.h"

#ifndef PCL_FFT_GROUND_WITH_LASZIP

namespace pcl_fft_ground::cli {

std::string unpackedLas(std::string_view) {
  throw WorkError(std::string("it is compressed (LAZ), and this program is built without LASzip: ") +
                  UNPACK_LAZ);
}

std::string packedLas(std::string_view las) {
  return unpackedLas(las);
}

}  // namespace pcl_fft_ground::cli

#else

#include <laszip/laszip_api.h>

#include <algorithm>
#include <functional>
#include <ios>
#include <sstream>
#include <utility>

#include "separate_process.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr const char* DAMAGED = "it is truncated or damaged: ";

template <typename Number>
void putAt(std::string& bytes, std::size_t place, Number number) {
  std::memcpy(bytes.data() + place, &number, sizeof number);
}

/// A reader or writer of LASzip's.
class Laszip {
 public:
  Laszip() { check(laszip_create(&handle_)); }
  ~Laszip() { laszip_destroy(handle_); }
  Laszip(const Laszip&) = delete;
  Laszip& operator=(const Laszip&) = delete;

  operator laszip_POINTER() const { return handle_; }

  /// \throws WorkError with what LASzip says where it has failed
  void check(laszip_I32 status) const {
    if (status == 0) return;
    laszip_CHAR* message = nullptr;
    if (handle_ != nullptr) laszip_get_error(handle_, &message);
    throw WorkError(std::string(DAMAGED) + "LASzip says '" + (message == nullptr ? "" : message) + "'");
  }

 private:
  laszip_POINTER handle_ = nullptr;
};

/// The byte at which the table of the compressed chunks begins, which ends what LASzip writes and is told of
/// in front of the points. \throws WorkError where it is not in the file: LASzip itself would read on without
/// it
std::int64_t chunkTablePlace(std::string_view laz, const LasHeader& header) {
  constexpr std::size_t table_head = 8;
  std::int64_t place = 0;
  if (header.points_begin + sizeof place <= laz.size())
    place = numberAt<std::int64_t>(laz, header.points_begin);
  if (place == -1) place = numberAt<std::int64_t>(laz, laz.size() - sizeof place);  // written as a stream
  if (place <= 0 || static_cast<std::uint64_t>(place) + table_head > laz.size())
    throw WorkError(std::string(DAMAGED) + "the table of its compressed chunks, at byte " +
                    std::to_string(place) + ", is not among its " + std::to_string(laz.size()));
  return place;
}

/// Gives all points of a file, compressed or not, to a writer that is open. Nothing is allocated for points
/// that the file only claims to have.
void copyPoints(std::string_view file, const LasHeader& header, const Laszip& writer) {
  const bool has_table = header.is_compressed && header.points > 0;
  const std::int64_t points_end = has_table ? chunkTablePlace(file, header) : 0;
  std::istringstream stream{std::string(file)};
  const Laszip reader;
  laszip_BOOL is_compressed = 0;
  reader.check(laszip_open_reader_stream(reader, stream, &is_compressed));
  laszip_point_struct* point = nullptr;
  reader.check(laszip_get_point_pointer(reader, &point));
  for (std::size_t n = 0; n < header.points; ++n) {
    if (laszip_read_point(reader) != 0)
      throw WorkError(DAMAGED + ("its header counts " + std::to_string(header.points)) +
                      " points, and only " + std::to_string(n) + " can be unpacked");
    writer.check(laszip_set_point(writer, point));
    writer.check(laszip_write_point(writer));
  }
  if (has_table && stream.tellg() > points_end)
    throw WorkError(DAMAGED + ("its header counts " + std::to_string(header.points)) +
                    " points, more than its compressed chunks hold");
  reader.check(laszip_close_reader(reader));
}

/// What `function` returns, from a process of its own: LASzip crashes on some damaged files.
std::string safely(const std::function<std::string()>& function) {
  Outcome outcome = runApart(function);
  if (outcome.end == End::REFUSED) throw WorkError(outcome.bytes);
  if (outcome.end == End::CRASHED) throw WorkError(std::string(DAMAGED) + "LASzip crashes on it");
  if (outcome.end != End::DONE)
    throw WorkError(std::string(DAMAGED) + "LASzip wants more memory than there is");
  return std::move(outcome.bytes);
}

enum class Compression { OFF, ON };

/// `head` and, behind it, the points of a file. \param head its size is a place in the result
std::string withPoints(const std::string& head, std::string_view file, const LasHeader& header,
                       Compression compression) {
  std::ostringstream stream(head, std::ios::binary | std::ios::ate);
  {
    const Laszip writer;
    writer.check(
        laszip_set_point_type_and_size(writer, header.format, static_cast<laszip_U16>(header.record_bytes)));
    const laszip_BOOL is_compressed = compression == Compression::ON, has_header = 1;
    writer.check(laszip_open_writer_stream(writer, stream, is_compressed, has_header));
    copyPoints(file, header, writer);
    writer.check(laszip_close_writer(writer));
  }
  return stream.str();
}

/// The record that tells how points of such a form are compressed.
std::string compressionRecord(const LasHeader& header) {
  const Laszip writer;
  writer.check(
      laszip_set_point_type_and_size(writer, header.format, static_cast<laszip_U16>(header.record_bytes)));
  laszip_U8* bytes = nullptr;
  laszip_U32 size = 0;
  writer.check(laszip_create_laszip_vlr(writer, &bytes, &size));
  return {reinterpret_cast<const char*>(bytes), size};
}

/// LASzip's record, and those of the order of the chunks in a COPC file, which would no longer be true.
bool isOfCompression(const VariableRecord& record) {
  return record.user == "laszip encoded" || record.user == "copc";
}

std::vector<VariableRecord> recordsBefore(std::string_view file, const LasHeader& header) {
  return variableRecords(file.substr(0, header.points_begin), header.header_bytes,
                         numberAt<std::uint32_t>(file, 100), RecordKind::PLAIN);
}

// Places in a header.
constexpr std::size_t POINTS_BEGIN = 96, RECORDS = 100, FORMAT = 104, WAVES_BEGIN = 227, EXTENDED_BEGIN = 235,
                      EXTENDED_RECORDS = 243;

/// Header and records of a file, with other records. \param added behind the others
std::string headOf(std::string_view file, const LasHeader& header, const std::string& added) {
  std::string head(file.substr(0, header.header_bytes));
  std::size_t end = header.header_bytes;
  std::uint32_t count = added.empty() ? 0 : 1;
  for (const VariableRecord& record : recordsBefore(file, header)) {
    end += record.whole.size();
    if (isOfCompression(record)) continue;
    head += record.whole;
    ++count;
  }
  head += added;
  head += file.substr(end, header.points_begin - end);
  putAt(head, RECORDS, count);
  putAt(head, POINTS_BEGIN, static_cast<std::uint32_t>(head.size()));
  putAt(head, FORMAT, static_cast<std::uint8_t>(header.format | (added.empty() ? 0U : 0x80U)));
  return head;
}

/// Appends the extended records of `file` to `result`, whose header gets their new places.
void appendExtended(std::string_view file, const LasHeader& header, std::string& result) {
  const auto placeAt = [&](std::size_t place) { return numberAt<std::uint64_t>(file, place); };
  const std::uint64_t waves = header.minor >= 3 ? placeAt(WAVES_BEGIN) : 0;
  const bool is_counted = header.minor >= 4;
  const std::uint64_t begin = is_counted ? placeAt(EXTENDED_BEGIN) : waves;
  const std::uint32_t count = is_counted ? numberAt<std::uint32_t>(file, EXTENDED_RECORDS) : waves != 0;
  if (count == 0 || begin < header.points_begin) return;
  const auto records =
      variableRecords(file, std::min<std::uint64_t>(begin, file.size()), count, RecordKind::EXTENDED);
  if (records.size() < count)
    throw WorkError(DAMAGED + ("its header counts " + std::to_string(count)) + " extended records, and " +
                    std::to_string(records.size()) + " are there");
  std::uint32_t kept = 0;
  if (is_counted) putAt(result, EXTENDED_BEGIN, static_cast<std::uint64_t>(result.size()));
  for (const VariableRecord& record : records) {
    if (isOfCompression(record)) continue;
    if (static_cast<std::uint64_t>(record.whole.data() - file.data()) == waves)
      putAt(result, WAVES_BEGIN, static_cast<std::uint64_t>(result.size()));
    result += record.whole;
    ++kept;
  }
  if (!is_counted) return;
  putAt(result, EXTENDED_RECORDS, kept);
  if (kept == 0) putAt(result, EXTENDED_BEGIN, std::uint64_t{0});
}

}  // namespace

std::string unpackedLas(std::string_view laz) {
  const LasHeader header = parseLasHeader(laz, laz.size());
  std::string las =
      safely([&] { return withPoints(headOf(laz, header, ""), laz, header, Compression::OFF); });
  appendExtended(laz, header, las);
  return las;
}

std::string packedLas(std::string_view las) {
  const LasHeader header = parseLasHeader(las, las.size());
  std::string laz = withPoints(headOf(las, header, compressionRecord(header)), las, header, Compression::ON);
  appendExtended(las, header, laz);
  return laz;
}

}  // namespace pcl_fft_ground::cli

#endif
