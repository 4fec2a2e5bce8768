#include "tiles/site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "errors.h"
#include "io/output_file.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/tiles/tile_ground.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr std::size_t PART = 1 << 18;      // points that are held at a time
constexpr std::size_t SAMPLE = 1 << 20;    // points that tell origin, far points and up; of fewer all do
constexpr std::size_t WAITING = 1 << 26;   // bytes that wait for being written
constexpr std::size_t MOST_LABELS = 1000;  // different ones: more are no classes

const char* const SITE_FILE = "site";

/// Points taken evenly from all over a file.
struct FileSample {
  Eigen::Vector3d origin;
  core::RawPoints points;
};

FileSample sampleOfFile(CloudStream& stream) {
  constexpr std::size_t RUN = 256;  // consecutive points: fewer would be read no faster
  const std::size_t count = stream.points(), step = std::max<std::size_t>(count / SAMPLE, 1);
  const std::size_t run = step > 1 ? RUN : PART;
  Coordinates xyz;
  for (std::size_t first = 0; first < count; first += run * step) {
    const std::size_t length = std::min(run, count - first);
    RawCloud raw = stream.read(first, length);
    const Coordinates part = coordinatesOf(raw);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < length; ++n)
        xyz[axis].push_back(n < raw.withheld.size() && raw.withheld[n]
                                ? std::numeric_limits<double>::quiet_NaN()
                                : part[axis][n]);
  }
  FileSample sample;
  sample.origin = {core::wholeOrigin(xyz[0]), core::wholeOrigin(xyz[1]), core::wholeOrigin(xyz[2])};
  sample.points.resize(3, static_cast<Eigen::Index>(xyz[0].size()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (Eigen::Index n = 0; n < sample.points.cols(); ++n)
      sample.points(axis, n) = static_cast<float>(
          xyz[static_cast<std::size_t>(axis)][static_cast<std::size_t>(n)] - sample.origin[axis]);
  return sample;
}

/// The different numbers of the labels, NaN left out.
void gatherLabels(const std::vector<double>& numbers, std::set<double>& different) {
  for (const double number : numbers)
    if (std::isfinite(number) && different.size() < MOST_LABELS) different.insert(number);
}

/// Finds what prepare() finds of a scan that is whole.
void scanSite(CloudStream& stream, const ReadOptions& reading, const SiteRequest& request,
              const Advance& advance, Site& site) {
  const FileSample sample = sampleOfFile(stream);
  site.origin = sample.origin;
  site.bounds = core::SiteBounds(sample.points);
  core::BoundsInParts bounds;
  std::set<double> labels;
  std::uint64_t finite = 0;
  eachPart(
      stream, site.origin,
      [&](std::size_t, const SitePart& part) {
        const core::RawPoints points = rawPoints(*part.cloud.points);
        for (Eigen::Index n = 0; n < points.cols(); ++n) finite += points.col(n).allFinite() ? 1U : 0U;
        bounds.add(site.bounds.usedOf(points));
        gatherLabels(part.labels, labels);
      },
      [&](double share) { advance(0.2 * share); });
  site.used = static_cast<std::uint64_t>(bounds.points());
  site.input_bounds = bounds.bounds();
  site.far = finite - site.used;
  if (site.used == 0)
    throw WorkError(stream.path() + ": none of its " + std::to_string(stream.points()) +
                    " points is finite; at least one has to be");
  const LabelVerdict verdict = judgeLabels({labels.begin(), labels.end()}, stream.read(0, 1), reading);
  site.meaning = verdict.meaning;
  site.label_fault = verdict.fault;

  core::StatisticsInParts in_parts(bounds);
  eachPart(
      stream, site.origin,
      [&](std::size_t, const SitePart& part) {
        in_parts.add(site.bounds.usedOf(rawPoints(*part.cloud.points)));
      },
      [&](double share) { advance(0.2 + 0.2 * share); });
  const core::PointStatistics statistics = in_parts.statistics();
  core::FrameParameters parameters = request.frame;
  if (request.sensor) parameters.sensor_position = *request.sensor - site.origin;
  site.up = core::estimateUp(site.bounds.usedOf(sample.points), statistics, parameters);
  core::LevelFrameInParts frame(statistics, site.up.axis);
  eachPart(
      stream, site.origin,
      [&](std::size_t, const SitePart& part) {
        frame.add(site.bounds.usedOf(rawPoints(*part.cloud.points)));
      },
      [&](double share) { advance(0.4 + 0.25 * share); });
  const core::LevelFrameInParts::Result level = frame.result(parameters.yaw);
  site.frame_from_input = level.frame_from_input;
  site.level_bounds = level.bounds;
}

void planTiles(const SiteRequest& request, Site& site) {
  site.plan = core::planRobustGround(request.robust, site.level_bounds, static_cast<Eigen::Index>(site.used));
  site.tiling = core::tilingOf(site.plan, request.tile_size);
  constexpr std::size_t MOST_TILES = 100000;
  if (site.tiling.size() > MOST_TILES)
    throw UsageError("--tile: the site would have " + std::to_string(site.tiling.size()) +
                     " tiles; allowed are sizes that give at most " + std::to_string(MOST_TILES));
}

std::vector<std::string> pathsOf(const TileStore& store, std::size_t tiles, const char* kind) {
  std::vector<std::string> paths;
  for (std::size_t t = 0; t < tiles; ++t) paths.push_back(store.path(t, kind));
  return paths;
}

/// Writes every point to the file of its tile and, where a fit looks at it, to those of all tiles that see
/// it.
void sortPoints(CloudStream& stream, const TileStore& store, const Advance& advance, Site& site) {
  const core::Tiling& tiling = site.tiling;
  ManyFiles points(pathsOf(store, tiling.size(), "points"), WAITING / 2);
  ManyFiles samples(pathsOf(store, tiling.size(), "sample"), WAITING / 2);
  site.points_of_tile.assign(tiling.size(), 0);
  site.samples_of_tile.assign(tiling.size(), 0);
  site.sum = 0;
  constexpr std::size_t BYTES = 3 * sizeof(float);
  eachPart(
      stream, site.origin,
      [&](std::size_t, const SitePart& part) {
        site.sum = sumWith(site.sum, *part.cloud.points);
        const core::Points used = site.bounds.usedOf(rawPoints(*part.cloud.points));
        const core::Points level = core::transformed(used, site.frame_from_input);
        for (Eigen::Index n = 0; n < used.cols(); ++n) {
          const auto [i, j] = tiling.cellAt(level(0, n), level(1, n));
          const std::size_t tile = tiling.tileAt(i, j);
          points.append(tile, used.data() + 3 * n, BYTES);
          ++site.points_of_tile[tile];
        }
        const core::Points sample = core::plannedSample(level, site.plan);
        for (Eigen::Index n = 0; n < sample.cols(); ++n) {
          const auto [i, j] = tiling.cellAt(sample(0, n), sample(1, n));
          for (const std::size_t tile : tiling.tilesIn(tiling.grown({i, j, 1, 1}, tiling.margin()))) {
            samples.append(tile, sample.data() + 3 * n, BYTES);
            ++site.samples_of_tile[tile];
          }
        }
      },
      advance);
  points.flush();
  samples.flush();
}

void putText(const std::string& text, ByteWriter& writer) {
  writer.putAll(std::vector<char>(text.begin(), text.end()));
}

std::string takeText(ByteReader& reader) {
  const std::vector<char> text = reader.takeAll<char>();
  return {text.begin(), text.end()};
}

void putTexts(const std::vector<std::string>& texts, ByteWriter& writer) {
  writer.put(static_cast<std::uint64_t>(texts.size()));
  for (const std::string& text : texts) putText(text, writer);
}

std::vector<std::string> takeTexts(ByteReader& reader) {
  std::vector<std::string> texts(reader.take<std::uint64_t>());
  for (std::string& text : texts) text = takeText(reader);
  return texts;
}

template <typename Vector>
void putCoordinates(const Vector& values, ByteWriter& writer) {
  writer.putAll(values.data(), static_cast<std::size_t>(values.size()));
}

void saveSite(const Site& site, const CloudStream& stream, const SiteRequest& request,
              const TileStore& store) {
  ByteWriter writer;
  putText(stream.path(), writer);
  putText(stream.stamp(), writer);
  putText(request.settings, writer);
  putCoordinates(site.origin, writer);
  for (const core::Bounds& bounds : {site.bounds.within(), site.input_bounds, site.level_bounds}) {
    putCoordinates(bounds.low, writer);
    putCoordinates(bounds.high, writer);
  }
  putCoordinates(site.frame_from_input.matrix(), writer);
  putCoordinates(site.up.axis, writer);
  writer.put(site.up.side_from);
  writer.put(site.up.axis_confidence);
  writer.put(site.up.side_confidence);
  putTexts(site.up.reasons, writer);
  putTexts(site.up.warnings, writer);
  writer.put(site.used);
  writer.put(site.far);
  writer.put(site.sum);
  writer.put(site.meaning.has_value());
  if (site.meaning) {
    writer.putAll(site.meaning->ground);
    writer.putAll(site.meaning->ignored);
  }
  putText(site.label_fault, writer);
  writer.putAll(site.points_of_tile);
  writer.putAll(site.samples_of_tile);
  store.write(store.path(SITE_FILE), writer);
}

template <typename Vector>
void takeCoordinates(ByteReader& reader, Vector& values) {
  reader.takeAll(values.data(), static_cast<std::size_t>(values.size()));
}

/// \return nothing where no run was cut off
std::optional<Site> loadSite(const CloudStream& stream, const SiteRequest& request, const TileStore& store) {
  std::error_code ignored;
  if (!std::filesystem::exists(store.path(SITE_FILE), ignored)) return std::nullopt;
  ByteReader reader = store.read(store.path(SITE_FILE));
  const std::string of = "'" + store.folder() + "' holds a run that was cut off, ";
  const char* const way_out = ": remove that folder to begin anew";
  if (takeText(reader) != stream.path()) throw WorkError(of + "of another file" + way_out);
  if (takeText(reader) != stream.stamp())
    throw WorkError(of + "and '" + stream.path() + "' has changed since" + way_out);
  if (takeText(reader) != request.settings) throw WorkError(of + "with other options" + way_out);
  Site site;
  takeCoordinates(reader, site.origin);
  core::Bounds within;
  for (core::Bounds* bounds : {&within, &site.input_bounds, &site.level_bounds}) {
    takeCoordinates(reader, bounds->low);
    takeCoordinates(reader, bounds->high);
  }
  site.bounds = core::SiteBounds(within);
  takeCoordinates(reader, site.frame_from_input.matrix());
  takeCoordinates(reader, site.up.axis);
  site.up.side_from = reader.take<core::SideSource>();
  site.up.axis_confidence = reader.take<double>();
  site.up.side_confidence = reader.take<double>();
  site.up.reasons = takeTexts(reader);
  site.up.warnings = takeTexts(reader);
  site.used = reader.take<std::uint64_t>();
  site.far = reader.take<std::uint64_t>();
  site.sum = reader.take<std::uint64_t>();
  if (reader.take<bool>()) {
    site.meaning.emplace();
    site.meaning->ground = reader.takeAll<int>();
    site.meaning->ignored = reader.takeAll<int>();
  }
  site.label_fault = takeText(reader);
  site.points_of_tile = reader.takeAll<std::uint64_t>();
  site.samples_of_tile = reader.takeAll<std::uint64_t>();
  planTiles(request, site);
  return site;
}

}  // namespace

void eachPart(CloudStream& stream, const Eigen::Vector3d& origin,
              const std::function<void(std::size_t first, SitePart part)>& visit, const Advance& advance) {
  for (std::size_t first = 0; first < stream.points(); first += PART) {
    const std::size_t count = std::min(PART, stream.points() - first);
    RawCloud raw = stream.read(first, count);
    SitePart part;
    part.labels = labelNumbers(raw);
    const Coordinates xyz = coordinatesOf(raw);
    part.cloud = interpretCoordinates(std::move(raw), xyz, origin);
    visit(first, std::move(part));
    advance(static_cast<double>(first + count) / static_cast<double>(stream.points()));
  }
}

std::uint64_t sumWith(std::uint64_t sum, const pcl::PointCloud<pcl::PointXYZ>& points) {
  for (const auto& point : points) {
    std::array<std::uint32_t, 3> bits{};
    std::memcpy(bits.data(), point.data, sizeof bits);
    for (const std::uint32_t word : bits) sum = (sum ^ word) * 0x100000001b3U;
    sum ^= sum >> 29U;
  }
  return sum;
}

core::RawPoints rawPoints(const pcl::PointCloud<pcl::PointXYZ>& points) {
  core::RawPoints raw(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n)
    raw.col(static_cast<Eigen::Index>(n)) = points[n].getVector3fMap();
  return raw;
}

Site prepareSite(CloudStream& stream, const ReadOptions& reading, const SiteRequest& request,
                 const TileStore& store, const Advance& advance) {
  if (std::optional<Site> found = loadSite(stream, request, store)) return std::move(*found);
  store.begin();
  Site site;
  scanSite(stream, reading, request, advance, site);
  planTiles(request, site);
  sortPoints(
      stream, store, [&](double share) { advance(0.65 + 0.35 * share); }, site);
  saveSite(site, stream, request, store);
  return site;
}

}  // namespace pcl_fft_ground::cli
