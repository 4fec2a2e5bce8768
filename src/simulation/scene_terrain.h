#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/simulation_random.h"

namespace pcl_fft_ground::core {

/// A half line; \c direction has unit length, so that ranges along it are metres.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;

  Eigen::Vector3d at(double range) const { return origin + range * direction; }
};

/// An elliptical Gaussian hill.
struct Mound {
  Eigen::Vector2d centre;          ///< [m]
  Eigen::Matrix2d scaled_from_xy;  ///< offset from the centre [m] -> offset in standard deviations
  double height;                   ///< [m]
};

/// amplitude * cos(wave_vector . xy + phase)
struct Wave {
  Eigen::Vector2d wave_vector;  ///< [rad/m]
  double amplitude;             ///< [m]
  double phase;                 ///< [rad]
};

/// One octave of gradient noise (Perlin 2002) on its own turned and shifted lattice.
struct NoiseOctave {
  Eigen::Matrix2d lattice_from_xy;  ///< rotation over lattice spacing [1/m]
  Eigen::Vector2d shift;            ///< [lattice cells]
  double amplitude;                 ///< roughly the largest height [m]
  std::uint32_t seed;
};

/// Height of the bottom over the horizontal plane, defined everywhere: z = height(x, y).
struct Terrain {
  double level = 0.0;                               ///< height added everywhere [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< gradient of the mean plane
  std::vector<Mound> mounds;
  std::vector<Wave> waves;
  std::vector<NoiseOctave> roughness;

  double height(double x, double y) const;
};

/// Fractal roughness: octaves from \c longest down to 6 cm, amplitudes falling as wavelength^0.9.
std::vector<NoiseOctave> fractalRoughness(double longest, double amplitude, Random& random);

/// A wave of the given length [m] and amplitude [m], its direction and phase random.
Wave randomWave(double wavelength, double amplitude, Random& random);

/** Range at which a falling ray meets the ground.
 *  \pre the ray descends more steeply than any slope of the terrain, so that there is one crossing only
 *  \param guess where to start the search [m] */
double groundRange(const Terrain& terrain, const Ray& ray, double guess);

}  // namespace pcl_fft_ground::core
