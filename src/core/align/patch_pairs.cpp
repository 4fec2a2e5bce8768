#include "align/patch_pairs.h"

#include <algorithm>
#include <cmath>

#include "align/jackknife.h"

namespace pcl_fft_ground::core {

Eigen::Vector3d centreOf(const std::vector<PatchPair>& pairs) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PatchPair& p : pairs) sum += p.to;
  return sum / static_cast<double>(pairs.size());
}

MotionFit fitOf(const std::vector<PatchPair>& pairs, const Eigen::Vector3d& centre) {
  MotionFit fit(centre);
  for (const PatchPair& p : pairs) fit.addToPlane(p.from, p.to, p.normal, p.weight);
  return fit;
}

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

}  // namespace pcl_fft_ground::core
