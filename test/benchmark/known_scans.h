#pragma once

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pcl_fft_ground/simulation/simulation.h"

// The scans with a known ground on which benchmarks judge what is said of it.

const std::vector<std::pair<std::string, pcl_fft_ground::core::SceneKind>> KINDS{
    {"wreck", pcl_fft_ground::core::SceneKind::WRECK},
    {"pipes", pcl_fft_ground::core::SceneKind::PIPES},
    {"reef", pcl_fft_ground::core::SceneKind::REEF}};

/// 300,000 points, 30 % of them on objects of up to 1 m.
inline pcl_fft_ground::core::SimulatedScan benchmarkScan(pcl_fft_ground::core::SceneKind kind,
                                                         std::uint32_t seed) {
  pcl_fft_ground::core::SimulationParameters parameters;
  parameters.scene = kind;
  parameters.object_share = 0.3;
  parameters.points = 300000;
  parameters.seed = seed;
  return pcl_fft_ground::core::simulateScan(parameters);
}

/// Labelled scans, and the size of the largest object there [m].
const std::vector<std::pair<std::string, double>> LAND{{"isprs/isprs_samp12", 40},
                                                       {"isprs/isprs_samp21", 40},
                                                       {"isprs/isprs_samp23", 40},
                                                       {"isprs/isprs_samp31", 40},
                                                       {"isprs/isprs_samp42", 40},
                                                       {"isprs/isprs_samp51", 40},
                                                       {"isprs/isprs_samp53", 40},
                                                       {"land/ahn3_town", 40},
                                                       {"land/autzen", 60},
                                                       {"land/embankment", 40},
                                                       {"land/forest_dense_canopy", 20},
                                                       {"land/forest_lakes", 20},
                                                       {"land/forest_low_vegetation", 20},
                                                       {"land/ign_sparse", 60},
                                                       {"land/ign_town", 30},
                                                       {"land/indoor_room", 3},
                                                       {"land/roof_at_corner", 40},
                                                       {"land/semkitti_seq00_000000", 10},
                                                       {"oakland/oakland_part2_ac", 10},
                                                       {"oakland/oakland_part2_ag", 10},
                                                       {"oakland/oakland_part3_al", 10},
                                                       {"oakland/oakland_part3_ao", 10},
                                                       {"mosd/mosd_learn0", 0.4},
                                                       {"mosd/mosd_learn2", 0.4},
                                                       {"mosd/mosd_test55", 0.4}};

/// Whether PCL_FFT_GROUND_DATA tells where these are.
inline bool hasLand() {
  return std::getenv("PCL_FFT_GROUND_DATA") != nullptr;
}

/// One of them; label 0 is ground, 1 object, 2 neither.
inline pcl::PointCloud<pcl::PointXYZL> landScan(const std::string& name) {
  const std::string path = std::string(std::getenv("PCL_FFT_GROUND_DATA")) + "/" + name + ".pcd";
  pcl::PointCloud<pcl::PointXYZL> cloud;
  if (pcl::io::loadPCDFile(path, cloud) != 0) throw std::runtime_error(path + " cannot be read");
  return cloud;
}
