#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "simulation/scene.h"
#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// Which rectangle of a site is scanned, from where, and by what scanner.
struct ScanGeometry {
  Eigen::Isometry3d site_from_track =
      Eigen::Isometry3d::Identity();  ///< origin amid the footprint, x along the track
  Eigen::Vector2d footprint;          ///< length along and width across the track [m]
  double altitude;                    ///< of the laser above the track frame's z = 0 [m]
  double baseline;                    ///< camera behind the laser [m]
};

/// Rays of one scan: profiles along the track, samples across it.
struct RayPattern {
  int profiles;
  int samples;
};

/// One measured place, without noise, in the site's frame.
struct Sighting {
  Eigen::Vector3d position;   ///< [m]
  Eigen::Vector3d direction;  ///< of the ray, unit length
  double ground;              ///< height of the ground at the position's x, y [m]
  int object;                 ///< index of the object, -1 for the ground
};

/// Parts of the footprint from which nothing comes back: blotches half a metre across.
class GapMask {
 public:
  /// \param share of the footprint, 0 to 1; reached to one cell of 2.5 cm
  GapMask(const Eigen::Vector2d& footprint, double share, Random random);
  bool isGap(const Eigen::Vector2d& track_xy) const;

 private:
  Eigen::Vector2d corner_;
  Eigen::Array2i count_;
  std::vector<char> gap_;
};

/// A pattern of about \c rays rays, equally dense along and across the track, wide enough for the footprint.
RayPattern rayPattern(const Scene& scene, const ScanGeometry& geometry, double rays);

/** \brief All that the scanner sees, profile after profile.
 *  \pre the ground lies below the laser, and no slope of it is as steep as a ray */
std::vector<Sighting> sense(const Scene& scene, const ScanGeometry& geometry, const RayPattern& pattern,
                            const GapMask& gaps, Random random);

}  // namespace pcl_fft_ground::core
