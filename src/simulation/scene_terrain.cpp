#include "simulation/scene_terrain.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace pcl_fft_ground::core {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr unsigned kDirections = 64;

std::array<Eigen::Vector2d, kDirections> unitCircle() {
  std::array<Eigen::Vector2d, kDirections> directions;
  for (unsigned i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * kPi * i / kDirections;
    directions[i] = {std::cos(angle), std::sin(angle)};
  }
  return directions;
}

// Not local to the function that reads it: a check at each of its billions of calls would cost a fifth.
const std::array<Eigen::Vector2d, kDirections> kDirectionTable = unitCircle();

/// The random direction that belongs to a lattice point.
const Eigen::Vector2d& gradientAt(std::int32_t column, std::int32_t row, std::uint32_t seed) {
  std::uint32_t h = seed + static_cast<std::uint32_t>(column) * 0x8da6b343U;
  h += static_cast<std::uint32_t>(row) * 0xd8163841U;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  return kDirectionTable[(h ^ (h >> 15)) % kDirections];
}

/// std::floor is a call into the library on the oldest x86-64.
std::int32_t floored(double x) {
  const auto truncated = static_cast<std::int32_t>(x);
  return truncated - (x < truncated ? 1 : 0);
}

double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double gradientNoise(const NoiseOctave& octave, const Eigen::Vector2d& xy) {
  const Eigen::Vector2d at = octave.lattice_from_xy * xy + octave.shift;
  const std::int32_t i = floored(at.x());
  const std::int32_t j = floored(at.y());
  const double u = at.x() - i;
  const double v = at.y() - j;
  const auto corner = [&](int di, int dj) {
    const Eigen::Vector2d& gradient = gradientAt(i + di, j + dj, octave.seed);
    return gradient.x() * (u - di) + gradient.y() * (v - dj);
  };
  const double a = fade(u);
  const double lower = corner(0, 0) + a * (corner(1, 0) - corner(0, 0));
  const double upper = corner(0, 1) + a * (corner(1, 1) - corner(0, 1));
  // Unit gradients on a unit lattice reach 1/sqrt 2.
  return std::sqrt(2.0) * octave.amplitude * (lower + fade(v) * (upper - lower));
}

double moundHeight(const Mound& mound, const Eigen::Vector2d& xy) {
  return mound.height * std::exp(-0.5 * (mound.scaled_from_xy * (xy - mound.centre)).squaredNorm());
}

}  // namespace

double Terrain::height(double x, double y) const {
  const Eigen::Vector2d xy(x, y);
  double z = level + slope.dot(xy);
  for (const Mound& mound : mounds) z += moundHeight(mound, xy);
  for (const Wave& wave : waves) z += wave.amplitude * std::cos(wave.wave_vector.dot(xy) + wave.phase);
  for (const NoiseOctave& octave : roughness) z += gradientNoise(octave, xy);
  return z;
}

std::vector<NoiseOctave> fractalRoughness(double longest, double amplitude, Random& random) {
  constexpr double kShortest = 0.06;  // three cells of the usual grid: finer relief drowns in the noise
  constexpr double kRoughnessExponent = 0.9;
  std::vector<NoiseOctave> octaves;
  for (double wavelength = longest; wavelength >= kShortest; wavelength /= 2.0) {
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const double shift_x = random.uniform(0.0, 100.0);
    const double shift_y = random.uniform(0.0, 100.0);
    NoiseOctave octave;
    octave.lattice_from_xy = Eigen::Rotation2Dd(turn).toRotationMatrix() / wavelength;
    octave.shift = {shift_x, shift_y};
    octave.amplitude = amplitude * std::pow(wavelength / longest, kRoughnessExponent);
    octave.seed = random.bits();
    octaves.push_back(octave);
  }
  return octaves;
}

Wave randomWave(double wavelength, double amplitude, Random& random) {
  const double direction = random.uniform(0.0, 2.0 * kPi);
  const double phase = random.uniform(0.0, 2.0 * kPi);
  const Eigen::Vector2d along(std::cos(direction), std::sin(direction));
  return {2.0 * kPi / wavelength * along, amplitude, phase};
}

double groundRange(const Terrain& terrain, const Ray& ray, double guess) {
  constexpr double kEnough = 1e-6;  // [m], far below the noise
  constexpr int kMaxSteps = 50;
  const auto clearance = [&](double range) {
    const Eigen::Vector3d p = ray.at(range);
    return p.z() - terrain.height(p.x(), p.y());
  };
  double range = guess;
  double above = clearance(range);
  if (ray.direction.x() == 0.0 && ray.direction.y() == 0.0) return range + above;
  double descent = -ray.direction.z();  // clearance lost per metre: exact over flat ground, then by secants
  for (int step = 0; step < kMaxSteps && std::abs(above) > kEnough; ++step) {
    const double next = range + above / descent;
    const double next_above = clearance(next);
    const double secant = (above - next_above) / (next - range);
    range = next;
    above = next_above;
    if (secant > 0.2 * descent && secant < 5.0 * descent) descent = secant;
  }
  return range;
}

}  // namespace pcl_fft_ground::core
