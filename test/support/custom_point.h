#pragma once

#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace pcl_fft_ground::test {

/// A return of a scanning sonar as a user may define it: x, y, z are neither first nor alone.
struct EIGEN_ALIGN16 SonarPoint {
  double time = 0;           ///< [s]
  std::uint16_t beam = 0;    ///< number of the beam
  float intensity = 0;       ///< strength of the return [dB]
  PCL_ADD_POINT4D;           // x, y, z [m]
  std::uint8_t quality = 0;  ///< 0 bad .. 255 good
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace pcl_fft_ground::test

POINT_CLOUD_REGISTER_POINT_STRUCT(pcl_fft_ground::test::SonarPoint,
                                  (double, time, time)(std::uint16_t, beam, beam)(float, intensity,
                                                                                  intensity)(float, x, x)(
                                      float, y, y)(float, z, z)(std::uint8_t, quality, quality))
