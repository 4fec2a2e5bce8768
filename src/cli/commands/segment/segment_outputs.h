#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/cloud_file.h"
#include "methods/segmentation.h"

namespace pcl_fft_ground::cli {

/// Writes labelled.pcd, ground.pcd and objects.pcd: the input's points with all their fields and `label` and
/// `segment`; a label or segment that the input brought is kept as `truth` or `truth_segment`.
void writeClouds(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes ground_surface.pcd, a point per cell in the frame of the input, and ground_surface.asc, the surface
/// resampled to the input's x and y axes.
void writeGroundSurface(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes segments.csv, a row per segment.
void writeSegments(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation);

/// Writes elevation.png, ground.png, spectrum.png, labels.png and segments.png.
void writePictures(const std::string& directory, const Segmenter& segmenter, const Segmentation& segmentation,
                   const Cloud& cloud);

}  // namespace pcl_fft_ground::cli
