#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

#include "commands/segment/tiled_run.h"
#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double NO_DATA = std::numeric_limits<double>::quiet_NaN();

/// Hands out what the tiles have found of the points of the file, in the order of the file.
class LabelCursor {
 public:
  explicit LabelCursor(const TiledRun& run) : run_(run), tiles_(run.site.tiling.size()) {}

  struct Found {
    core::Label label = core::Label::NEITHER;
    std::int32_t segment = 0;
    double height = NO_DATA;
    float ground_probability = std::numeric_limits<float>::quiet_NaN();
  };

  /// \param level a point that is used, in the level frame
  Found next(const Eigen::Vector3f& level) {
    const core::Tiling& tiling = run_.site.tiling;
    const auto [i, j] = tiling.cellAt(level.x(), level.y());
    const std::size_t t = tiling.tileAt(i, j);
    OfTile& tile = tiles_[t];
    if (tile.next == tile.end) refill(t);
    const std::size_t n = tile.next++ - tile.begin;
    Found found{tile.labels[n], 0, static_cast<double>(tile.heights[n]), tile.probabilities[n]};
    if (found.label == core::Label::OBJECT) found.segment = tile.segments[tile.next_object++];
    return found;
  }

 private:
  /// A piece of what one tile has found.
  struct OfTile {
    std::size_t begin = 0, end = 0, next = 0;  // points of the tile
    std::size_t object = 0, next_object = 0;   // objects up to `end`, and in the piece
    std::vector<core::Label> labels;
    std::vector<float> heights, probabilities;
    std::vector<std::int32_t> segments;
  };

  void refill(std::size_t t) {
    constexpr std::size_t POINTS = 1 << 22;  // in all pieces
    OfTile& tile = tiles_[t];
    const std::size_t piece = std::max<std::size_t>(POINTS / tiles_.size(), 256);
    const TileLabels all = readLabels(run_.store, t);
    const std::vector<std::int32_t> numbers = numbersOf(run_.segments, run_.store, t);
    if (tile.end >= all.labels.size())
      throw WorkError("cannot read '" + run_.stream.path() + "': it has changed since it was sorted");
    tile.begin = tile.end;
    tile.end = std::min(tile.begin + piece, all.labels.size());
    const auto at = [](std::size_t n) { return static_cast<std::ptrdiff_t>(n); };
    tile.labels.assign(all.labels.begin() + at(tile.begin), all.labels.begin() + at(tile.end));
    tile.heights.assign(all.heights.begin() + at(tile.begin), all.heights.begin() + at(tile.end));
    tile.probabilities.assign(all.probabilities.begin() + at(tile.begin),
                              all.probabilities.begin() + at(tile.end));
    const auto objects =
        static_cast<std::size_t>(std::count(tile.labels.begin(), tile.labels.end(), core::Label::OBJECT));
    tile.segments.assign(numbers.begin() + at(tile.object), numbers.begin() + at(tile.object + objects));
    tile.object += objects;
    tile.next_object = 0;
  }

  const TiledRun& run_;
  std::vector<OfTile> tiles_;
};

void add(const core::Confusion& part, core::Confusion& sum) {
  sum.true_positives += part.true_positives;
  sum.false_positives += part.false_positives;
  sum.true_negatives += part.true_negatives;
  sum.false_negatives += part.false_negatives;
}

/// Points of a part by their labels.
Segmentation segmentationOf(const TiledRun& run, const Cloud& cloud, LabelCursor& cursor, CellViews& views) {
  Segmentation result;
  const core::RawPoints points = rawPoints(*cloud.points);
  const core::Points level = core::transformed(run.site.bounds.usedOf(points), run.site.frame_from_input);
  Eigen::Index used = 0;
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    LabelCursor::Found found;
    switch (run.site.bounds.useOf(points.col(n))) {
      case core::PointUse::USED:
        found = cursor.next(level.col(used));
        views.add(level.col(used++).cast<double>(), found.label, found.segment, found.height);
        break;
      case core::PointUse::FAR:
        found.label = core::Label::OBJECT;
        found.ground_probability = 0;
        break;
      case core::PointUse::UNUSABLE:
        break;
    }
    result.labels.push_back(found.label);
    result.segments.push_back(found.segment);
    result.heights.push_back(found.height);
    result.ground_probability.push_back(found.ground_probability);
    if (found.label == core::Label::GROUND) result.ground.indices.push_back(static_cast<pcl::index_t>(n));
    if (found.label == core::Label::OBJECT) result.objects.indices.push_back(static_cast<pcl::index_t>(n));
  }
  return result;
}

/// labelled.las: the bytes of the input but for the classes.
class LasCopy {
 public:
  explicit LasCopy(const TiledRun& run) : run_(run), file_(run.store, run.directory, "labelled.las") {
    copy(0, run.stream.records().begin);
  }

  void write(std::size_t first, const Segmentation& part) {
    const RecordFile& records = run_.stream.records();
    std::string bytes = run_.stream.bytes(records.begin + first * records.record_bytes,
                                          part.labels.size() * records.record_bytes);
    const LasClasses& classes = run_.request.classes;
    for (std::size_t n = 0; n < part.labels.size(); ++n) {
      if (part.labels[n] == core::Label::NEITHER) continue;
      const bool is_object = part.labels[n] == core::Label::OBJECT;
      records.reclassify(bytes.data() + n * records.record_bytes, !is_object            ? classes.ground
                                                                  : part.heights[n] < 0 ? classes.below
                                                                                        : classes.object);
    }
    file_.write(bytes);
  }

  void finish() {
    const RecordFile& records = run_.stream.records();
    copy(records.begin + records.points() * records.record_bytes, run_.stream.fileSize());
    file_.finish();
  }

 private:
  void copy(std::uint64_t begin, std::uint64_t end) {
    constexpr std::uint64_t AT_ONCE = 1 << 22;
    for (std::uint64_t at = begin; at < end; at += AT_ONCE)
      file_.write(run_.stream.bytes(at, static_cast<std::size_t>(std::min(AT_ONCE, end - at))));
  }

  const TiledRun& run_;
  GrowingFile file_;
};

}  // namespace

void GrowingFile::write(const char* bytes, std::size_t count) {
  errno = 0;
  stream_.write(bytes, static_cast<std::streamsize>(count));
  if (!stream_) fail();
}

void GrowingFile::finish() {
  errno = 0;
  stream_.close();
  if (!stream_) fail();
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) throw WorkError("cannot write '" + path_ + "': " + error.message());
}

void GrowingFile::fail() const {
  throw WorkError("cannot write '" + path_ + "': " + (errno != 0 ? std::strerror(errno) : "writing failed"));
}

PointOutputs writePoints(const TiledRun& run, const PointCounts& expected, CellViews& views,
                         const Advance& advance) {
  PointOutputs outputs;
  GrowingFile labelled(run.store, run.directory, "labelled.pcd"),
      ground(run.store, run.directory, "ground.pcd"), objects(run.store, run.directory, "objects.pcd");
  std::optional<LasCopy> las;
  if (run.stream.format() == CloudFormat::LAS) las.emplace(run);
  LabelCursor cursor(run);
  std::uint64_t sum = 0;
  const auto header = [](pcl::PCLPointCloud2 points, long long width, long long height,
                         const Viewpoint& viewpoint) {
    points.width = static_cast<std::uint32_t>(width);
    points.height = static_cast<std::uint32_t>(height);
    return pcdHeader(points, viewpoint);
  };
  eachPart(
      run.stream, run.site.origin,
      [&](std::size_t first, const SitePart& part) {
        sum = sumWith(sum, *part.cloud.points);
        Segmentation found = segmentationOf(run, part.cloud, cursor, views);
        outputs.counts.ground += static_cast<long long>(found.ground.indices.size());
        outputs.counts.objects += static_cast<long long>(found.objects.indices.size());
        if (run.site.meaning && !part.labels.empty()) {
          if (!outputs.confusion) outputs.confusion.emplace();
          add(core::compare(labelsBy(*run.site.meaning, part.labels), found.labels), *outputs.confusion);
        }
        if (las) las->write(first, found);
        if (!run.request.heights) found.heights.clear(), found.ground_probability.clear();
        const pcl::PCLPointCloud2 all = labelledFields(part.cloud, found);
        if (first == 0) {
          const auto width = static_cast<long long>(run.stream.records().width),
                     height = static_cast<long long>(run.stream.records().height);
          labelled.write(header(all, width, height, part.cloud.viewpoint));
          ground.write(header(all, expected.ground, 1, part.cloud.viewpoint));
          objects.write(header(all, expected.objects, 1, part.cloud.viewpoint));
        }
        labelled.write(all);
        ground.write(selectPoints(all, found.ground.indices));
        objects.write(selectPoints(all, found.objects.indices));
      },
      advance);
  if (sum != run.site.sum)
    throw WorkError("cannot read '" + run.stream.path() + "': it has changed since it was sorted");
  labelled.finish();
  ground.finish();
  objects.finish();
  if (las) las->finish();
  outputs.counts.neither =
      static_cast<long long>(run.stream.points()) - outputs.counts.ground - outputs.counts.objects;
  outputs.counts.segments = static_cast<int>(run.segments.count());
  return outputs;
}

}  // namespace pcl_fft_ground::cli
