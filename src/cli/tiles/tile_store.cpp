#include "tiles/tile_store.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "errors.h"
#include "io/output_file.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

/// FNV-1a over words of eight bytes.
std::uint64_t sumOf(const char* bytes, std::size_t count) {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (std::size_t place = 0; place < count; place += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + place, std::min<std::size_t>(8, count - place));
    sum = (sum ^ word) * 0x100000001b3U;
    sum ^= sum >> 29U;
  }
  return sum;
}

[[noreturn]] void failDamaged(const std::string& path) {
  throw WorkError("cannot read '" + path + "': it is missing or damaged; to begin anew remove its folder");
}

std::string readAll(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) failDamaged(path);
  std::string content(size, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(content.data(), static_cast<std::streamsize>(size));
  if (!stream) failDamaged(path);
  return content;
}

template <typename Array>
void putArray(const Array& values, ByteWriter& writer) {
  writer.put(static_cast<std::uint64_t>(values.size()));
  writer.putAll(values.data(), static_cast<std::size_t>(values.size()));
}

template <typename Array>
Array takeArray(Eigen::Index rows, Eigen::Index cols, ByteReader& reader) {
  const auto size = reader.take<std::uint64_t>();
  if (size == 0) return {};
  Array values(rows, cols);
  reader.takeAll(values.data(), static_cast<std::size_t>(values.size()));
  return values;
}

void putRegion(const core::StandingRegion& region, ByteWriter& writer) {
  writer.put(region.slope);
  writer.put(region.is_land);
  writer.put(region.broad);
  for (const Eigen::Index end : {region.low_row, region.low_col, region.high_row, region.high_col})
    writer.put(end);
  for (const double sum : {region.area, region.border, region.pairs, region.ground_pairs, region.gentle_pairs,
                           region.higher_pairs})
    writer.put(sum);
  std::vector<Eigen::Index> seam;
  for (const auto& [row, col] : region.seam) seam.insert(seam.end(), {row, col});
  writer.putAll(seam);
}

core::StandingRegion takeRegion(ByteReader& reader) {
  core::StandingRegion region;
  region.slope = reader.take<core::BreakSlope>();
  region.is_land = reader.take<bool>();
  region.broad = reader.take<bool>();
  for (Eigen::Index* end : {&region.low_row, &region.low_col, &region.high_row, &region.high_col})
    *end = reader.take<Eigen::Index>();
  for (double* sum : {&region.area, &region.border, &region.pairs, &region.ground_pairs, &region.gentle_pairs,
                      &region.higher_pairs})
    *sum = reader.take<double>();
  const auto seam = reader.takeAll<Eigen::Index>();
  for (std::size_t n = 0; n + 1 < seam.size(); n += 2) region.seam.emplace_back(seam[n], seam[n + 1]);
  return region;
}

}  // namespace

void ByteReader::require(std::size_t bytes) const {
  if (bytes > bytes_.size() - place_) failDamaged(path_);
}

TileStore::TileStore(const std::string& output_directory) : folder_(output_directory + "/.tiles") {}

std::string TileStore::path(std::size_t tile, const char* kind) const {
  return folder_ + "/" + std::to_string(tile) + "." + kind;
}

bool TileStore::has(std::size_t tile, const char* kind) const {
  std::error_code ignored;
  return fs::exists(path(tile, kind), ignored);
}

void TileStore::begin() const {
  remove();
  makeDirectory(folder_);
}

void TileStore::remove() const {
  std::error_code error;
  fs::remove_all(folder_, error);
  if (error) throw WorkError("cannot remove '" + folder_ + "': " + error.message());
}

void TileStore::write(const std::string& file, const ByteWriter& content) const {
  std::string bytes = content.bytes();
  const std::uint64_t sum = sumOf(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  writeText(file, bytes);
}

ByteReader TileStore::read(const std::string& file) const {
  std::string bytes = readAll(file);
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) failDamaged(file);
  const std::size_t count = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + count, sizeof sum);
  if (sumOf(bytes.data(), count) != sum) failDamaged(file);
  bytes.resize(count);
  return {std::move(bytes), file};
}

core::Points TileStore::readPoints(std::size_t tile, const char* kind, std::size_t expected) const {
  core::Points points(3, static_cast<Eigen::Index>(expected));
  if (expected == 0) return points;
  const std::string file = path(tile, kind);
  std::error_code error;
  const std::size_t bytes = expected * 3 * sizeof(float);
  if (fs::file_size(file, error) != bytes || error) failDamaged(file);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(bytes));
  if (!stream) failDamaged(file);
  return points;
}

ManyFiles::ManyFiles(std::vector<std::string> paths, std::size_t memory)
    : paths_(std::move(paths)),
      waiting_(paths_.size()),
      most_(std::max<std::size_t>(memory / std::max<std::size_t>(paths_.size(), 1), 1 << 12)) {}

void ManyFiles::append(std::size_t file, const void* bytes, std::size_t count) {
  waiting_[file].append(static_cast<const char*>(bytes), count);
  if (waiting_[file].size() >= most_) flush(file);
}

void ManyFiles::flush() {
  for (std::size_t file = 0; file < paths_.size(); ++file) flush(file);
}

void ManyFiles::flush(std::size_t file) {
  if (waiting_[file].empty()) return;
  errno = 0;
  std::ofstream stream(paths_[file], std::ios::binary | std::ios::app);
  stream.write(waiting_[file].data(), static_cast<std::streamsize>(waiting_[file].size()));
  stream.close();
  if (!stream)
    throw WorkError("cannot write '" + paths_[file] +
                    "': " + (errno != 0 ? std::strerror(errno) : "writing failed"));
  waiting_[file].clear();
}

void putGround(const core::TileGround& tile, ByteWriter& writer) {
  const core::RobustGround& ground = tile.ground;
  const core::GridGeometry& cells = ground.elevation.geometry;
  writer.put(tile.window);
  writer.put(cells.origin.x());
  writer.put(cells.origin.y());
  writer.put(cells.cell_size);
  writer.put(ground.scale);
  writer.put(ground.land_breaks);
  writer.putAll(ground.wavelengths);
  writer.put(static_cast<std::uint64_t>(ground.standing.size()));
  for (const core::StandingRegion& region : ground.standing) putRegion(region, writer);
  putArray(ground.elevation.elevation, writer);
  putArray(ground.elevation.observed, writer);
  putArray(ground.surface.height, writer);
  putArray(ground.surface.supported, writer);
  putArray(ground.surface.uncertainty, writer);
  putArray(ground.lowest, writer);
  putArray(ground.steps, writer);
}

core::TileGround takeGround(ByteReader& reader) {
  core::TileGround tile;
  core::RobustGround& ground = tile.ground;
  tile.window = reader.take<core::CellWindow>();
  core::GridGeometry cells;
  cells.rows = tile.window.rows;
  cells.cols = tile.window.cols;
  cells.origin.x() = reader.take<double>();
  cells.origin.y() = reader.take<double>();
  cells.cell_size = reader.take<double>();
  ground.elevation.geometry = ground.surface.geometry = cells;
  ground.scale = reader.take<double>();
  ground.land_breaks = reader.take<bool>();
  ground.wavelengths = reader.takeAll<double>();
  for (auto regions = reader.take<std::uint64_t>(); regions > 0; --regions)
    ground.standing.push_back(takeRegion(reader));
  ground.elevation.elevation = takeArray<Eigen::ArrayXXd>(cells.rows, cells.cols, reader);
  ground.elevation.observed = takeArray<core::Mask>(cells.rows, cells.cols, reader);
  ground.surface.height = takeArray<Eigen::ArrayXXd>(cells.rows, cells.cols, reader);
  ground.surface.supported = takeArray<core::Mask>(cells.rows, cells.cols, reader);
  ground.surface.uncertainty = takeArray<Eigen::ArrayXXd>(cells.rows, cells.cols, reader);
  ground.lowest = takeArray<Eigen::ArrayXXf>(cells.rows, cells.cols, reader);
  ground.steps = takeArray<Eigen::ArrayXXf>(cells.rows, cells.cols, reader);
  return tile;
}

}  // namespace pcl_fft_ground::cli
