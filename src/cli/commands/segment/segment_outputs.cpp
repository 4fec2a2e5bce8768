#include "commands/segment/segment_outputs.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <pcl/conversions.h>

#include "errors.h"
#include "io/output_file.h"
#include "io/raster_files.h"
#include "pcl_fft_ground/core/grid/scan_coverage.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "pcl_fft_ground/core/segments/object_properties.h"
#include "pcl_fft_ground/impl/indexed_points.hpp"
#include "pictures/raster.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr double NO_DATA = std::numeric_limits<double>::quiet_NaN();

std::vector<std::int32_t> numbersOf(const core::Labels& labels) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(labels.size());
  for (const core::Label label : labels) numbers.push_back(static_cast<std::int32_t>(label));
  return numbers;
}

/// The centre of every cell on the ground, in the frame of the input; organised as the grid.
pcl::PointCloud<Point> surfacePoints(const core::GroundSurface& surface) {
  const core::GridGeometry& cells = surface.geometry;
  const Eigen::Isometry3d input_from_frame = surface.frame_from_input.inverse();
  pcl::PointCloud<Point> points(static_cast<std::uint32_t>(cells.rows),
                                static_cast<std::uint32_t>(cells.cols));
  for (Eigen::Index j = 0; j < cells.cols; ++j)
    for (Eigen::Index i = 0; i < cells.rows; ++i) {
      const Eigen::Vector3d centre(cells.origin.x() + (static_cast<double>(i) + 0.5) * cells.cell_size,
                                   cells.origin.y() + (static_cast<double>(j) + 0.5) * cells.cell_size,
                                   surface.height(i, j));
      points[static_cast<std::size_t>(i + j * cells.rows)].getVector3fMap() =
          (input_from_frame * centre).cast<float>();
    }
  return points;
}

bool covers(const core::GridGeometry& cells, const Eigen::Vector3d& p) {
  const Eigen::Array2d place = (p.head<2>() - cells.origin).array() / cells.cell_size;
  return (place >= 0).all() && place.x() <= static_cast<double>(cells.rows) &&
         place.y() <= static_cast<double>(cells.cols);
}

/// Height at which the vertical of the input through (x, y) meets the surface; NaN beside the surface.
double verticalHeight(const core::GroundSurface& surface, double x, double y) {
  const double upward = surface.frame_from_input.linear()(2, 2);
  if (std::abs(upward) < 0.1) return NO_DATA;  // the surface stands on end: a vertical does not meet it once
  constexpr int MOST_STEPS = 20;
  constexpr double CLOSE = 1e-6;  // [m], a hundredth of what the grid's four digits show
  double z = 0, change = 1;
  for (int step = 0; step < MOST_STEPS && std::abs(change) > CLOSE; ++step) {
    change = surface.heightAbove({x, y, z}) / upward;
    z -= change;
  }
  return covers(surface.geometry, surface.frame_from_input * Eigen::Vector3d(x, y, z)) ? z : NO_DATA;
}

/// The surface's own cell size, or a larger one: a long scan that lies across the axes, in a grid along them,
/// would need many times the cells that it has.
double levelCellSize(const core::Bounds& bounds, const core::GridGeometry& cells) {
  constexpr double MOST_CELLS_PER_CELL = 16;
  const double most =
      std::min(0.99 * core::MAX_CELLS, MOST_CELLS_PER_CELL * static_cast<double>(cells.rows * cells.cols));
  const double needed = ((bounds.high - bounds.low).head<2>() / cells.cell_size + 1).prod();
  return needed <= most ? cells.cell_size : cells.cell_size * std::sqrt(needed / most);
}

/// The surface over the input's x and y axes. A cell is centred on the outermost points: they lie at cell
/// centres of the surface.
GroundRaster resampled(const core::GroundSurface& surface, const core::Bounds& bounds, double cell_size) {
  const core::GridGeometry level = core::gridAround(bounds, cell_size);
  GroundRaster raster;
  raster.lower_left_corner = level.origin - Eigen::Vector2d::Constant(0.5 * level.cell_size);
  raster.cell_size = level.cell_size;
  raster.height.resize(level.rows, level.cols);
  raster.uncertainty.setConstant(level.rows, level.cols, NO_DATA);
  raster.supported.setConstant(level.rows, level.cols, 0);
  core::GroundSurface uncertainty{surface.frame_from_input, surface.geometry, surface.uncertainty};
  for (Eigen::Index j = 0; j < level.cols; ++j)
    for (Eigen::Index i = 0; i < level.rows; ++i) {
      const Eigen::Vector2d place =
          level.origin + level.cell_size * Eigen::Vector2d(static_cast<double>(i), static_cast<double>(j));
      const double height = raster.height(i, j) = verticalHeight(surface, place.x(), place.y());
      if (!std::isfinite(height)) continue;
      const Eigen::Vector3d p = surface.frame_from_input * Eigen::Vector3d(place.x(), place.y(), height);
      const Eigen::Index cell = cellBelow(surface.geometry, p);
      const bool tells = surface.supported.size() > 0;
      raster.supported(i, j) = !tells || (cell >= 0 && surface.supported.data()[cell]) ? 1 : 0;
      if (uncertainty.height.size() > 0) raster.uncertainty(i, j) = uncertainty.heightAt(p.x(), p.y());
    }
  return raster;
}

/// A raster in the coordinates of the file, and without what is not supported.
GroundRaster placed(GroundRaster raster, const Eigen::Vector3d& origin) {
  raster.lower_left_corner += origin.head<2>();
  const auto known = raster.supported > 0;
  raster.height = known.select(raster.height + origin.z(), NO_DATA);
  raster.uncertainty = known.select(raster.uncertainty, NO_DATA);
  return raster;
}

}  // namespace

pcl::PCLPointCloud2 labelledFields(const Cloud& cloud, const Segmentation& segmentation) {
  pcl::PCLPointCloud2 labelled = cloud.fields;
  renameField(labelled, "label", "truth");
  renameField(labelled, "segment", "truth_segment");
  setInt32Field(labelled, "label", numbersOf(segmentation.labels));
  setInt32Field(labelled, "segment", segmentation.segments);
  if (!segmentation.heights.empty()) {
    renameField(labelled, "height", "input_height");
    setFloatField(labelled, "height", {segmentation.heights.begin(), segmentation.heights.end()});
  }
  if (!segmentation.ground_probability.empty()) {
    renameField(labelled, "p_ground", "input_p_ground");
    setFloatField(labelled, "p_ground", segmentation.ground_probability);
  }
  return labelled;
}

void writeClouds(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation) {
  const pcl::PCLPointCloud2 labelled = labelledFields(cloud, segmentation);
  const auto write = [&](const std::string& name, const pcl::PCLPointCloud2& points) {
    writePcd(directory + "/" + name, points, cloud.viewpoint);
  };
  write("labelled.pcd", labelled);
  write("ground.pcd", selectPoints(labelled, segmentation.ground.indices));
  write("objects.pcd", selectPoints(labelled, segmentation.objects.indices));
}

void writeLas(const std::string& directory, const std::string& input, const Cloud& cloud,
              const Segmenter& segmenter, const Segmentation& segmentation, const LasClasses& classes) {
  // Only the robust estimator calls points objects because they lie below the ground.
  const bool tells_below = segmenter.fft != nullptr && segmenter.fft->getEstimator() == Estimator::ROBUST;
  const std::vector<double> heights =
      tells_below ? segmenter.filter->getHeightAboveGround() : std::vector<double>();
  std::vector<int> numbers(segmentation.labels.size(), -1);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (segmentation.labels[n] == core::Label::GROUND) numbers[n] = classes.ground;
    if (segmentation.labels[n] == core::Label::OBJECT)
      numbers[n] = tells_below && heights[n] < 0 ? classes.below : classes.object;
  }
  writeReclassified(directory + (cloud.is_compressed ? "/labelled.laz" : "/labelled.las"), input, numbers);
}

void writeGroundSurface(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation,
                        const RasterOptions& raster) {
  const core::GroundSurface& surface = segmentation.surface;
  const pcl::PointCloud<Point> points = surfacePoints(surface);
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(points, fields);
  if (surface.supported.size() > 0) {
    setInt32Field(fields, "supported",
                  {surface.supported.data(), surface.supported.data() + surface.supported.size()});
    const Eigen::ArrayXXf uncertainty = surface.uncertainty.cast<float>();
    setFloatField(fields, "uncertainty", {uncertainty.data(), uncertainty.data() + uncertainty.size()});
  }
  writePcd(directory + "/ground_surface.pcd", fields, cloud.viewpoint);

  core::Points corners(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n)
    corners.col(static_cast<Eigen::Index>(n)) = points[n].getVector3fMap();
  const core::Bounds bounds = core::boundsOf(corners);
  const double cell_size = levelCellSize(bounds, surface.geometry);
  const GroundRaster level = resampled(surface, bounds, cell_size);
  writeAsciiGrid(directory + "/ground_surface.asc", level.height, level.lower_left_corner, level.cell_size);
  if (!canWriteGeoTiff()) return;
  const double cells =
      ((bounds.high - bounds.low).head<2>() / std::max(raster.resolution, cell_size * 1e-9) + 1).prod();
  if (raster.resolution > 0 && cells > core::MAX_CELLS) {
    std::ostringstream message;
    message << "--raster-resolution " << raster.resolution << ": the raster would have more than "
            << core::MAX_CELLS << " cells";
    throw WorkError(message.str());
  }
  const bool same = raster.resolution == 0 || raster.resolution == cell_size;
  const std::string& crs = raster.crs.empty() && isKnownCrs(cloud.crs) ? cloud.crs : raster.crs;
  writeGeoTiff(directory + "/ground_surface.tif",
               placed(same ? level : resampled(surface, bounds, raster.resolution), cloud.origin), crs);
}

namespace {

/// Where the scan has looked, seen from above; nothing where a grid of it would be too large.
std::optional<core::ScanCoverage> coverageOf(const Cloud& cloud, double cell_size) {
  constexpr double CELLS = 2.5;  // as alignment has it
  const impl::IndexedPoints<Point> all(*cloud.points, nullptr);
  try {
    return core::coverageOf(core::usablePoints(all.finite().points).points, CELLS * cell_size);
  } catch (const std::length_error&) {
    return std::nullopt;
  }
}

/// The columns of segments.csv after the first nine.
constexpr const char* PROPERTY_COLUMNS =
    ",length,width,thickness,axis_x,axis_y,axis_z,footing,volume,steepest,at_border,body,body_x,body_y,body_"
    "z,"
    "body_axis_x,body_axis_y,body_axis_z,body_length,body_radius,body_residual";

void writeProperties(std::ostream& csv, const core::ObjectProperties& object) {
  const auto write = [&](const auto& vector) {
    csv << ',' << vector.x() << ',' << vector.y() << ',' << vector.z();
  };
  write(object.lengths);
  write(object.axes.col(0));
  csv << ',' << object.footing << ',' << std::setprecision(6) << object.volume << std::setprecision(4) << ','
      << object.steepest << ',' << (object.at_border ? 1 : 0);
  if (!object.body) {
    csv << ",,,,,,,,,,";
    return;
  }
  csv << ',' << (object.body->shape == core::RoundBody::Shape::CYLINDER ? "cylinder" : "ellipsoid");
  write(object.body->centre);
  write(object.body->axis);
  csv << ',' << object.body->length << ',' << object.body->radius << ',' << object.body->residual;
}

}  // namespace

std::string segmentHeader() {
  return std::string("segment,points,cx,cy,cz,ex,ey,ez,height") + PROPERTY_COLUMNS + '\n';
}

std::string segmentRow(std::size_t number, std::size_t size, const core::Points& points,
                       const std::vector<double>& heights, const core::ObjectView& view) {
  std::ostringstream csv;
  csv << std::fixed << std::setprecision(4);
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    const Eigen::Array3d p = points.col(n).array().cast<double>();
    low = low.min(p);
    high = high.max(p);
    sum += p;
  }
  const double height = *std::max_element(heights.begin(), heights.end());
  const Eigen::Array3d centroid = sum / static_cast<double>(points.cols()), extent = high - low;
  csv << number << ',' << size << ',' << centroid.x() << ',' << centroid.y() << ',' << centroid.z() << ','
      << extent.x() << ',' << extent.y() << ',' << extent.z() << ',' << height;
  writeProperties(csv, core::measureObject(points, heights, view));
  csv << '\n';
  return csv.str();
}

void writeSegments(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation) {
  std::string csv = segmentHeader();
  const double cell_size = segmentation.elevation.geometry.cell_size;
  const std::optional<core::ScanCoverage> coverage = coverageOf(cloud, cell_size);
  const core::ObjectView view{cell_size, segmentation.surface.frame_from_input.linear().row(2).transpose(),
                              coverage ? &*coverage : nullptr};
  for (std::size_t k = 0; k < segmentation.clusters.size(); ++k) {
    const pcl::Indices& indices = segmentation.clusters[k].indices;
    core::Points points(3, static_cast<Eigen::Index>(indices.size()));
    std::vector<double> heights;
    for (std::size_t n = 0; n < indices.size(); ++n) {
      const Eigen::Vector3f point = (*cloud.points)[static_cast<std::size_t>(indices[n])].getVector3fMap();
      points.col(static_cast<Eigen::Index>(n)) = point;
      heights.push_back(segmentation.surface.heightAbove(point.cast<double>()));
    }
    csv += segmentRow(k + 1, indices.size(), points, heights, view);
  }
  writeText(directory + "/segments.csv", csv);
}

}  // namespace pcl_fft_ground::cli
