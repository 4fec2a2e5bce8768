#include "commands/segment/tiled_segment.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <utility>

#include "commands/segment/segment_report.h"
#include "commands/segment/tiled_run.h"
#include "errors.h"
#include "io/output_file.h"
#include "pcl_fft_ground/core/grid/scan_coverage.h"
#include "pcl_fft_ground/core/ground/cutoff.h"
#include "pcl_fft_ground/core/ground/spectrum.h"
#include "pcl_fft_ground/version.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// The ground of a site over cells that are no more than a picture or a map needs.
struct SiteMosaic {
  core::ElevationGrid elevation;
  core::GroundSurface surface;
};

/// Sums over the site's cells in each cell of the mosaic.
class MosaicSums {
 public:
  explicit MosaicSums(const core::GridGeometry& site) : side_(sideOf(site)) {
    geometry_ = {site.origin, site.cell_size * static_cast<double>(side_), (site.rows + side_ - 1) / side_,
                 (site.cols + side_ - 1) / side_};
    height_ = uncertainty_ = elevation_ = Eigen::ArrayXXd::Zero(geometry_.rows, geometry_.cols);
    cells_ = observed_ = supported_ = Eigen::ArrayXXi::Zero(geometry_.rows, geometry_.cols);
  }

  void add(const core::TileGround& tile, const core::CellWindow& core) {
    const core::RobustGround& ground = tile.ground;
    for (Eigen::Index j = core.col; j < core.col + core.cols; ++j)
      for (Eigen::Index i = core.row; i < core.row + core.rows; ++i) {
        const Eigen::Index k = i - tile.window.row, l = j - tile.window.col, to_i = i / side_,
                           to_j = j / side_;
        ++cells_(to_i, to_j);
        height_(to_i, to_j) += ground.surface.height(k, l);
        uncertainty_(to_i, to_j) += ground.surface.uncertainty(k, l);
        supported_(to_i, to_j) += ground.surface.supported(k, l) ? 1 : 0;
        if (!ground.elevation.observed(k, l)) continue;
        ++observed_(to_i, to_j);
        elevation_(to_i, to_j) += ground.elevation.elevation(k, l);
      }
  }

  SiteMosaic mosaic(const Eigen::Isometry3d& frame_from_input) const {
    SiteMosaic result;
    const Eigen::ArrayXXd cells = cells_.cast<double>();
    result.surface = {frame_from_input, geometry_, height_ / cells};
    result.surface.uncertainty = uncertainty_ / cells;
    result.surface.supported = 2 * supported_ >= cells_;
    result.elevation = {geometry_, elevation_ / observed_.max(1).cast<double>(), observed_ > 0};
    core::fillEmptyCells(result.elevation.elevation, result.elevation.observed);
    return result;
  }

 private:
  /// Side of a cell of the mosaic in cells of the site.
  static Eigen::Index sideOf(const core::GridGeometry& site) {
    constexpr double MOST = 4e6;  // of a picture of a thousand points square there are 4 for each
    const double cells = static_cast<double>(site.rows) * static_cast<double>(site.cols);
    return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(std::sqrt(cells / MOST))));
  }

  Eigen::Index side_;
  core::GridGeometry geometry_;
  Eigen::ArrayXXd height_, uncertainty_, elevation_;
  Eigen::ArrayXXi cells_, observed_, supported_;
};

SiteMosaic mosaicOf(const TiledRun& run, const Advance& advance) {
  MosaicSums sums(run.site.tiling.site());
  for (std::size_t t = 0; t < run.site.tiling.size(); ++t) {
    sums.add(groundOf(run.site, run.ground, run.store, t), run.site.tiling.core(t));
    advance(static_cast<double>(t + 1) / static_cast<double>(run.site.tiling.size()));
  }
  return sums.mosaic(run.site.frame_from_input);
}

/// Where the site was looked at; nothing where a grid of it would be too large.
std::optional<core::ScanCoverage> coverageOf(const TiledRun& run, double cell_size) {
  constexpr double CELLS = 2.5;  // as for a scan that is held whole
  constexpr double MOST = 1e7;
  const core::Bounds& bounds = run.site.input_bounds;
  if (((bounds.high - bounds.low).head<2>() / (CELLS * cell_size) + 1).prod() > MOST) return std::nullopt;
  const core::GridGeometry cells = core::coverageCells(bounds, CELLS * cell_size);
  core::Mask occupied = core::Mask::Constant(cells.rows, cells.cols, false);
  for (std::size_t t = 0; t < run.site.tiling.size(); ++t) {
    const core::Points points = run.store.readPoints(t, "points", run.site.points_of_tile[t]);
    for (Eigen::Index n = 0; n < points.cols(); ++n) {
      const Eigen::Array2d at =
          (points.col(n).head<2>().cast<double>() - cells.origin).array() / cells.cell_size;
      occupied(static_cast<Eigen::Index>(at.x()), static_cast<Eigen::Index>(at.y())) = true;
    }
  }
  return core::coverageOf(cells, occupied);
}

/// A point of a segment as it waits for being measured.
struct SegmentPoint {
  std::int32_t number;
  float x, y, z, height;
};

constexpr std::uint64_t MEASURED = 1 << 22;  // of larger segments every second, third ... point is measured

/// Segments whose points fit into memory together: the numbers up to which each group goes.
std::vector<std::int32_t> groupsOf(const std::vector<std::uint64_t>& sizes) {
  constexpr std::uint64_t POINTS = 1 << 20;
  std::vector<std::int32_t> last;
  std::uint64_t sum = 0;
  for (std::size_t number = 1; number < sizes.size(); ++number) {
    sum += std::min(sizes[number], MEASURED);
    if (sum < POINTS && number + 1 < sizes.size()) continue;
    last.push_back(static_cast<std::int32_t>(number));
    sum = 0;
  }
  return last;
}

/// Sorts the points of segments into a file for each group.
void groupPoints(const TiledRun& run, const std::vector<std::int32_t>& last,
                 const std::vector<std::string>& paths) {
  for (const std::string& path : paths) std::filesystem::remove(path);  // of a run that was cut off
  ManyFiles files(paths, 1 << 25);
  std::vector<std::uint64_t> seen(run.segments.sizes.size(), 0);
  for (std::size_t t = 0; t < run.site.tiling.size(); ++t) {
    const TileObjects objects = readObjects(run.store, t);
    const std::vector<std::int32_t> numbers = numbersOf(run.segments, run.store, t);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      if (numbers[n] == 0) continue;
      const auto number = static_cast<std::size_t>(numbers[n]);
      const std::uint64_t one_in = (run.segments.sizes[number] + MEASURED - 1) / MEASURED;
      if (seen[number]++ % one_in != 0) continue;
      const Eigen::Vector3f p = objects.points.col(static_cast<Eigen::Index>(n));
      const SegmentPoint point{numbers[n], p.x(), p.y(), p.z(), objects.heights[n]};
      const auto group = std::lower_bound(last.begin(), last.end(), numbers[n]) - last.begin();
      files.append(static_cast<std::size_t>(group), &point, sizeof point);
    }
  }
  files.flush();
}

std::vector<SegmentPoint> readGroup(const std::string& path) {
  std::vector<SegmentPoint> points(std::filesystem::file_size(path) / sizeof(SegmentPoint));
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(points.data()),
              static_cast<std::streamsize>(points.size() * sizeof(SegmentPoint)));
  if (!stream) throw WorkError("cannot read '" + path + "'");
  std::stable_sort(points.begin(), points.end(),
                   [](const SegmentPoint& a, const SegmentPoint& b) { return a.number < b.number; });
  return points;
}

void writeSegmentTable(const TiledRun& run, const Advance& advance) {
  const double cell_size = run.site.plan.cells.cell_size;
  const std::optional<core::ScanCoverage> coverage = coverageOf(run, cell_size);
  const core::ObjectView view{cell_size, run.site.frame_from_input.linear().row(2).transpose(),
                              coverage ? &*coverage : nullptr};
  const std::vector<std::int32_t> last = groupsOf(run.segments.sizes);
  std::vector<std::string> paths;
  for (std::size_t g = 0; g < last.size(); ++g) paths.push_back(run.store.path(g, "group"));
  groupPoints(run, last, paths);
  GrowingFile csv(run.store, run.directory, "segments.csv");
  csv.write(segmentHeader());
  for (std::size_t g = 0; g < paths.size(); ++g) {
    const std::vector<SegmentPoint> group = readGroup(paths[g]);
    for (std::size_t begin = 0, end = 0; begin < group.size(); begin = end) {
      while (end < group.size() && group[end].number == group[begin].number) ++end;
      core::Points points(3, static_cast<Eigen::Index>(end - begin));
      std::vector<double> heights;
      for (std::size_t n = begin; n < end; ++n) {
        points.col(static_cast<Eigen::Index>(n - begin)) << group[n].x, group[n].y, group[n].z;
        heights.push_back(static_cast<double>(group[n].height));
      }
      const auto number = static_cast<std::size_t>(group[begin].number);
      csv.write(segmentRow(number, run.segments.sizes[number], points, heights, view));
    }
    std::filesystem::remove(paths[g]);
    advance(static_cast<double>(g + 1) / static_cast<double>(paths.size()));
  }
  csv.finish();
}

/// What the labels of all tiles come to.
struct LabelSums {
  PointCounts counts;
  std::uint64_t below = 0;
};

LabelSums sumsOfLabels(const Site& site, const TileStore& store) {
  LabelSums sums;
  sums.counts.objects = static_cast<long long>(site.far);
  for (std::size_t t = 0; t < site.tiling.size(); ++t) {
    const TileLabels labels = readLabels(store, t);
    sums.below += labels.below;
    sums.counts.objects += static_cast<long long>(labels.objects);
    sums.counts.ground += static_cast<long long>(labels.labels.size() - labels.objects);
  }
  return sums;
}

core::Cutoff cutoffOf(const Site& site, double cell_size) {
  core::Cutoff cutoff;
  cutoff.source = core::CutoffSource::FINEST_WAVELENGTH;
  cutoff.frequency = std::min(M_SQRT2, 2 * cell_size / site.plan.finest_wavelength);
  cutoff.object_size = core::largestObject(cutoff.frequency, cell_size);
  return cutoff;
}

SpectrumImage spectrumImage(const core::Spectrum& before, const SiteMosaic& mosaic,
                            const core::Cutoff& cutoff) {
  SpectrumImage image;
  image.before = core::magnitude(before);
  image.after = core::magnitude(core::forwardTransform(mosaic.surface.height));
  image.cutoff = cutoff.frequency;
  image.object_size = cutoff.object_size;
  image.cell_size = mosaic.elevation.geometry.cell_size;
  return image;
}

std::vector<std::string> warningsOf(const TiledRun& run, const Cloud& first, const PointCounts& counts,
                                    const ClusterParameters& clusters) {
  std::vector<std::string> warnings = first.remarks;
  if (!first.pose_fault.empty()) warnings.push_back(first.pose_fault + ": taken for none");
  if (!run.site.label_fault.empty()) warnings.push_back(run.site.label_fault);
  warnings.insert(warnings.end(), run.site.up.warnings.begin(), run.site.up.warnings.end());
  if (run.site.far > 0)
    warnings.push_back("points too far from all others to belong to the scan, left out as objects: " +
                       std::to_string(run.site.far));
  if (counts.segments == 0 && counts.objects >= static_cast<long long>(clusters.min_cluster_size))
    warnings.push_back("no segment has " + std::to_string(clusters.min_cluster_size) +
                       " points: a larger --leaf-size or a smaller --min-cluster-size may help");
  return warnings;
}

}  // namespace

ordered_json segmentByTiles(CloudStream& stream, const std::string& directory, const std::string& method,
                            const TiledRequest& request, Progress& progress) {
  const Advance advance = [&](double share) { progress.advance(share); };
  const TileStore store(directory);
  progress.begin("sort", "Sorting the points of " + stream.path() + " into tiles");
  const Site site = prepareSite(stream, request.reading, request.site, store, advance);
  const ClusterParameters clusters = request.clusters(site.plan.cells.cell_size);
  progress.begin("ground", "Finding the ground");
  fitGrounds(site, request.site, store, advance);
  const SiteGround ground = groundOfSite(site, request.site, store);
  progress.begin("label", "Separating ground from objects");
  labelTiles(site, ground, store, advance);
  const LabelSums sums = sumsOfLabels(site, store);
  progress.begin("cluster", "Clustering the objects");
  clusterTiles(site, clusters, store, advance);
  const SiteSegments segments = joinSegments(site, clusters, store);

  const TiledRun run{stream, directory, request, store, site, ground, segments};
  progress.begin("measure", "Measuring the segments");
  writeSegmentTable(run, advance);
  progress.begin("surface", "Writing the ground to " + directory);
  const SiteMosaic mosaic = mosaicOf(run, advance);
  RawCloud first_raw = stream.read(0, 1);
  const Coordinates first_place = coordinatesOf(first_raw);
  const Cloud first = interpretCoordinates(std::move(first_raw), first_place, site.origin);
  Segmentation of_site;
  of_site.surface = mosaic.surface;
  writeGroundSurface(directory, first, of_site, request.raster);
  progress.begin("write", "Writing the points to " + directory);
  CellViews views(mosaic.elevation.geometry);
  const PointOutputs outputs = writePoints(run, sums.counts, views, advance);
  progress.begin("pictures", "Drawing pictures to " + directory);
  const core::Spectrum spectrum = core::forwardTransform(mosaic.elevation.elevation);
  const core::Cutoff cutoff = cutoffOf(site, mosaic.elevation.geometry.cell_size);
  drawPictures(directory, views, mosaic.surface, spectrumImage(spectrum, mosaic, cutoff), outputs.counts);
  progress.end();

  const core::GridGeometry& cells = site.plan.cells;
  const std::uint64_t clustered =
      std::accumulate(segments.sizes.begin(), segments.sizes.end(), std::uint64_t{0});
  const double empty = 1 - static_cast<double>(ground.observed) /
                               (static_cast<double>(cells.rows) * static_cast<double>(cells.cols));
  return {{"version", PCL_FFT_GROUND_VERSION},
          {"input", stream.path()},
          {"method", method},
          {"parameters", request.parameters(clusters, ground.tolerances.choices)},
          {"up", describeUp(site.up)},
          {"frame_from_input", asRows(site.frame_from_input.matrix())},
          {"origin", {site.origin.x(), site.origin.y(), site.origin.z()}},
          {"tiles",
           {{"count", site.tiling.size()},
            {"margin", static_cast<double>(site.tiling.margin()) * cells.cell_size}}},
          {"counts",
           {{"points", stream.points()},
            {"ground", outputs.counts.ground},
            {"objects", outputs.counts.objects},
            {"neither", outputs.counts.neither},
            {"far", site.far},
            {"segments", segments.count()},
            {"points_in_segments", clustered}}},
          {"elevation", describeElevation(cells, empty)},
          {"ground",
           {{"finest_wavelength", site.plan.finest_wavelength},
            {"height_tolerance", ground.tolerances.tolerance},
            {"spread", ground.spread},
            {"supported_share", mosaic.surface.supported.cast<double>().mean()},
            {"points_below", sums.below}}},
          {"spectrum",
           describeSpectrum(spectrum, cutoff, core::findSpectrumPeaks(core::magnitude(spectrum), {}))},
          {"scores", describeScores(outputs.confusion)},
          {"warnings", warningsOf(run, first, outputs.counts, clusters)},
          {"seconds", describeSeconds(progress)}};
}

void forgetTiles(const std::string& directory) {
  TileStore(directory).remove();
}

}  // namespace pcl_fft_ground::cli
