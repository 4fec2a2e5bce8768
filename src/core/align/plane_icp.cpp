#include "align/icp.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace pcl_fft_ground::core {
namespace {

constexpr int MAX_ITERATIONS = 30;
constexpr Eigen::Index SAMPLE = 8000;     // patches of the moving scan that take part
constexpr double RADIUS = 2;              // of a patch: some 12 points [voxels]
constexpr double FLAT = 0.2;              // largest ratio of a flat patch's thickness to its breadth
constexpr double SAME_NORMAL = 0.985;     // least cosine between the normals of the same surface: 10 degrees
constexpr double REACH = 1.5;             // how far a patch looks for its counterpart [voxels]
constexpr double GATE = 0.5;              // largest distance between the planes of the same surface [voxels]
constexpr double SETTLED = 0.0005;        // a smaller step is the last [voxels]
constexpr double BLOCKS = 6;              // parts of the scene along its longer side, for the jackknife
constexpr double LEAST_DEVIATION = 0.02;  // of two planes, whatever the residuals say [voxels]

bool isFlat(const SurfacePatch& patch) {
  return !patch.normal.isZero() && patch.roughness < FLAT * FLAT * patch.breadth;
}

/// The median roughness [m^2]; above 0, so that perfect planes can be compared.
double typicalRoughness(const std::vector<SurfacePatch>& patches) {
  constexpr double PERFECT = 1e-12;
  if (patches.empty()) return PERFECT;
  std::vector<double> roughness;
  roughness.reserve(patches.size());
  for (const SurfacePatch& patch : patches) roughness.push_back(patch.roughness);
  const auto middle = roughness.begin() + static_cast<std::ptrdiff_t>(roughness.size() / 2);
  std::nth_element(roughness.begin(), middle, roughness.end());
  return std::max(*middle, PERFECT);
}

/// For each patch which of the squares, some BLOCKS a side, it lies in.
std::vector<std::size_t> blocksOf(const std::vector<SurfacePatch>& patches, double voxel_size) {
  Eigen::AlignedBox2d box;
  for (const SurfacePatch& patch : patches) box.extend(Eigen::Vector2d(patch.centre.head<2>()));
  const double side = std::max(voxel_size, box.isEmpty() ? 0 : box.sizes().maxCoeff() / BLOCKS);
  std::vector<std::size_t> blocks;
  for (const SurfacePatch& patch : patches) {
    const Eigen::Array2d cell = (patch.centre.head<2>() - box.min()) / side;
    blocks.push_back(static_cast<std::size_t>(cell.x()) * static_cast<std::size_t>(BLOCKS + 1) +
                     static_cast<std::size_t>(cell.y()));
  }
  return blocks;
}

/// Two patches of the same surface, one of the moving scan and one of the reference.
struct PatchPair {
  Eigen::Vector3d from;    ///< centre of the moving patch after the current correction [m]
  Eigen::Vector3d to;      ///< centre of its counterpart [m]
  Eigen::Vector3d normal;  ///< of unit length, amid the two
  double weight;           ///< in (0, 1]
  std::size_t block;       ///< number of the part of the scene
};

/// Mean place of the pairs.
Eigen::Vector3d centreOf(const std::vector<PatchPair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PatchPair& p : pairs) sum += p.to;
  return sum / static_cast<double>(pairs.size());
}

/// The equations that bring the patches into one plane, pair by pair.
MotionFit fitOf(const std::vector<PatchPair>& pairs, const Eigen::Vector3d& centre) {
  MotionFit fit(centre);
  for (const PatchPair& p : pairs) fit.addToPlane(p.from, p.to, p.normal, p.weight);
  return fit;
}

/// How well the pairs hold the correction.
IcpResult summarise(const std::vector<PatchPair>& pairs, const Eigen::Isometry3d& correction) {
  IcpResult result;
  result.correction = correction;
  if (pairs.empty()) return result;
  result.centre = centreOf(pairs);
  std::vector<MotionFit> blocks;
  double sum = 0;
  double weights = 0;
  for (const PatchPair& p : pairs) {
    blocks.resize(std::max(blocks.size(), p.block + 1), MotionFit(result.centre));
    blocks[p.block].addToPlane(p.from, p.to, p.normal, p.weight);
    sum += p.weight * std::pow(p.normal.dot(p.from - p.to), 2);
    weights += p.weight;
  }
  result.information = fitOf(pairs, result.centre).information();
  result.variance = sum / weights;
  result.spread = jackknifeCovariance(blocks);
  return result;
}

/// Pairs patches and moves them into one plane, in turns.
class PlaneIcp {
 public:
  explicit PlaneIcp(const ScanPair& pair)
      : pair_(pair),
        moving_surface_(transformed(pair.movingScan().surface, pair.initialGuess())),
        moving_search_(pair.parameters().neighbours(moving_surface_, pair.voxelSize())),
        search_(pair.parameters().neighbours(surface(), pair.voxelSize())),
        reference_fitter_(surface(), *search_, RADIUS * pair.voxelSize()),
        reference_(static_cast<std::size_t>(surface().cols())) {
    PatchFitter fitter(moving_surface_, *moving_search_, RADIUS * pair.voxelSize());
    const Points sample = evenSample(moving_surface_, SAMPLE);
    for (Eigen::Index n = 0; n < sample.cols(); ++n) {
      const SurfacePatch patch = fitter.around(sample.col(n));
      if (isFlat(patch)) moving_.push_back(patch);
    }
    block_ = blocksOf(moving_, pair.voxelSize());
    typical_ = typicalRoughness(moving_);
  }

  IcpResult run(const Eigen::Isometry3d& start) {
    Eigen::Isometry3d correction = start;
    for (int iteration = 0; iteration < MAX_ITERATIONS; ++iteration) {
      const std::vector<PatchPair> pairs = findPairs(correction);
      if (pairs.empty()) break;
      const Eigen::Vector3d centre = centreOf(pairs);
      const Eigen::Isometry3d motion = fitOf(pairs, centre).solve();
      correction = motion * correction;
      if ((motion * centre - centre).norm() < SETTLED * pair_.voxelSize()) break;
    }
    IcpResult result = summarise(findPairs(correction), correction);
    result.least_deviation = LEAST_DEVIATION * pair_.voxelSize();
    return result;
  }

 private:
  const Points& surface() const { return pair_.referenceScan().surface; }

  /// The counterpart's patch, fitted when it is first asked for.
  const SurfacePatch& referencePatch(Eigen::Index n) {
    std::optional<SurfacePatch>& patch = reference_[static_cast<std::size_t>(n)];
    if (!patch) patch = reference_fitter_.around(surface().col(n));
    return *patch;
  }

  std::optional<PatchPair> pairOf(std::size_t n, const Eigen::Isometry3d& correction) {
    const Eigen::Vector3d from = correction * moving_[n].centre;
    if (!pair_.referenceSees(from)) return std::nullopt;
    const auto reach = static_cast<float>(REACH * pair_.voxelSize());
    const Neighbour nearest = search_->nearest(from.cast<float>(), reach);
    if (nearest.index < 0) return std::nullopt;
    const SurfacePatch& counterpart = referencePatch(nearest.index);
    if (!isFlat(counterpart)) return std::nullopt;
    const Eigen::Vector3d turned = correction.linear() * moving_[n].normal;
    const double cosine = turned.dot(counterpart.normal);
    if (std::abs(cosine) < SAME_NORMAL) return std::nullopt;
    const Eigen::Vector3d normal = (turned + std::copysign(1.0, cosine) * counterpart.normal).normalized();
    const double distance = std::abs(normal.dot(from - counterpart.centre));
    const double gate = GATE * pair_.voxelSize();
    if (distance > gate) return std::nullopt;
    const double trust = typical_ / (typical_ + moving_[n].roughness + counterpart.roughness);
    return PatchPair{from, counterpart.centre, normal, trust * weightOf(distance, gate), block_[n]};
  }

  std::vector<PatchPair> findPairs(const Eigen::Isometry3d& correction) {
    std::vector<PatchPair> pairs;
    for (std::size_t n = 0; n < moving_.size(); ++n)
      if (const std::optional<PatchPair> pair = pairOf(n, correction)) pairs.push_back(*pair);
    return pairs;
  }

  const ScanPair& pair_;
  Points moving_surface_;
  std::unique_ptr<NearestNeighbours> moving_search_;
  std::unique_ptr<NearestNeighbours> search_;
  PatchFitter reference_fitter_;
  std::vector<SurfacePatch> moving_;  // where the initial guess puts them
  double typical_ = 0;                // roughness of them [m^2]
  std::vector<std::size_t> block_;
  std::vector<std::optional<SurfacePatch>> reference_;
};

}  // namespace

IcpResult alignPlanes(const ScanPair& pair, const Eigen::Isometry3d& start) {
  return PlaneIcp(pair).run(start);
}

}  // namespace pcl_fft_ground::core
