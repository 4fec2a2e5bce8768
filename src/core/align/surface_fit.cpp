#include "align/surface_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "scan/up_evidence.h"

namespace pcl_fft_ground::core {
namespace {

// The constants of surfaces; lengths in voxels, which are some 2.5 spacings of the points.
constexpr Eigen::Index SAMPLE = 3000;  // pieces of each scan that are compared
constexpr double RADIUS = 2;           // of a piece at least: some 12 points [voxels]...
constexpr double WIDER = 1.5;          // ...and so much more, time and again, where points are thin...
constexpr int WIDENINGS = 5;           // ...up to 15 voxels, as between the rings of a rotating laser...
constexpr std::size_t ENOUGH = 12;     // ...until there are so many
constexpr std::size_t FEWEST = 5;      // points of a piece
constexpr double FLAT = 0.2;           // largest ratio of a flat piece's thickness to its breadth
constexpr double REACH = 1.5;          // how far a piece looks for its counterpart [voxels]
constexpr double ALIKE = 0.86;         // least cosine between the normals of counterparts: 30 degrees
constexpr double SAME_PLANE = 0.985;   // least cosine of those that the pose is refined by: 10 degrees
constexpr double DEVIATIONS = 3;       // of noise within which counterparts agree
constexpr double FARTHEST = 1;         // but no farther than this [voxels]
constexpr double ANYWHERE = 6;         // breadth in which a surface lies by chance [voxels]
constexpr double OUTLIERS = 0.1;       // share of pieces that have changed or were measured badly
constexpr double SEEN_WITHIN = 2;      // of a surface a place belongs to it [voxels]
constexpr double COVERAGE_CELL = 2.5;  // side of a cell seen from above [voxels]
constexpr double BLOCKS = 6;           // parts of the scene along its longer side, for the jackknife
constexpr double SETTLED = 0.002;      // a smaller step is the last [voxels]

// ICP from afar.
constexpr std::size_t ONE_IN = 4;   // pieces that take part while the reach is large
constexpr double NEAR_REACH = 3;    // from which all of them do [voxels]
constexpr double LAST_REACH = 1.5;  // [voxels]
constexpr double STEP = 0.75;       // by which the reach shrinks
constexpr int STEPS = 25, LAST_STEPS = 12, REFINEMENTS = 30;

// The first look at a pose: a right one keeps its evidence, relative to others', to some per cent.
constexpr std::size_t ONE_OF_FEW = 5;  // pieces that are compared
constexpr int FEW_REFINEMENTS = 8;
constexpr double ALONG = 100;   // distances along a surface count so much less, squared
constexpr double ROBUST = 4;    // the scale of the weights is the reach over this...
constexpr double NOISES = 1.5;  // ...but no less than so many deviations of the noise

/// How much likelier a distance of 0 is between counterparts than between unrelated surfaces.
double peakOf(double variance, double voxel) {
  constexpr double ROOT_OF_TWO_PI = 2.50662827463100050;
  return (1 - OUTLIERS) * ANYWHERE * voxel / (ROOT_OF_TWO_PI * std::sqrt(variance));
}

std::optional<Eigen::Vector3d> sensorOf(const ScanSegments& scan) {
  if (scan.sensor) return scan.sensor;
  if (showsSensorAtOrigin(scan.relief)) return Eigen::Vector3d::Zero();
  return std::nullopt;
}

ViewField viewOf(const ScanSegments& scan) {
  const std::optional<Eigen::Vector3d> sensor = sensorOf(scan);
  return {sensor ? scan.relief : scan.surface, sensor, COVERAGE_CELL * scan.voxel_size};
}

/// A pair of correspondences of ICP from afar: both in the frame of the reference.
struct Pull {
  Eigen::Vector3d moving, reference;
  Eigen::Matrix3d weight;
};

Eigen::Vector3d middleOf(const std::vector<Pull>& pulls) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pull& pull : pulls) sum += pull.reference;
  return sum / static_cast<double>(pulls.size());
}

void addPulls(SurfaceModel& from, SurfaceModel& to, const Eigen::Isometry3d& to_from, double reach,
              std::size_t one_in, std::vector<Pull>& found) {
  const double noise = from.typicalVariance() + to.typicalVariance();
  const double scale = std::max(std::pow(reach / ROBUST, 2), NOISES * NOISES * noise);
  for (std::size_t k = 0; k < from.sample().size(); k += one_in) {
    const Surfel& piece = from.at(from.sample()[k]);
    const Eigen::Vector3d place = to_from * piece.centre;
    const Neighbour nearest = to.nearest(place, reach);
    if (nearest.index < 0) continue;
    const Surfel& counterpart = to.at(nearest.index);
    if (!counterpart.is_valid) continue;
    const Eigen::Vector3d normal = to_from.linear() * piece.normal;
    const Eigen::Matrix3d spread =
        2 * Eigen::Matrix3d::Identity() -
        (1 - 1 / ALONG) * (normal * normal.transpose() + counterpart.normal * counterpart.normal.transpose());
    const Eigen::Matrix3d inverse = spread.inverse();
    const Eigen::Vector3d apart = counterpart.centre - place;
    const double squared = apart.dot(inverse * apart) * 2 / ALONG;  // across, where the normals are alike
    const double trust = noise / (noise + piece.variance + counterpart.variance);
    found.push_back({place, counterpart.centre, trust / std::pow(1 + squared / scale, 2) * inverse});
  }
}

/// Which of the parts of the scene a place lies in.
class Blocks {
 public:
  explicit Blocks(const Points& points) {
    for (Eigen::Index n = 0; n < points.cols(); ++n)
      box_.extend(points.col(n).head<2>().cast<double>().eval());
    side_ = std::max(1e-12, box_.isEmpty() ? 0 : box_.sizes().maxCoeff() / BLOCKS);
  }
  std::size_t of(const Eigen::Vector3d& place) const {
    const Eigen::Array2d cell = ((place.head<2>() - box_.min()) / side_).array().max(0).min(BLOCKS);
    return static_cast<std::size_t>(cell.x()) * static_cast<std::size_t>(BLOCKS + 1) +
           static_cast<std::size_t>(cell.y());
  }

 private:
  Eigen::AlignedBox2d box_;
  double side_;
};

}  // namespace

SurfaceModel::SurfaceModel(const ScanSegments& scan, const NearestNeighboursFactory& neighbours)
    : scan_(scan),
      search_(neighbours(scan.surface, scan.voxel_size)),
      view_(viewOf(scan)),
      kept_(static_cast<std::size_t>(scan.surface.cols())) {
  const Eigen::Index total = scan.surface.cols(), count = std::min(SAMPLE, total);
  std::vector<double> flat, all;
  for (Eigen::Index n = 0; n < count; ++n) {
    const Eigen::Index index = n * total / count;
    const Surfel& piece = at(index);
    if (!piece.is_valid) continue;
    sample_.push_back(index);
    all.push_back(piece.variance);
    if (piece.is_flat) flat.push_back(piece.variance);
  }
  std::vector<double>& variances = flat.empty() ? all : flat;
  if (variances.empty()) return;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  constexpr double PERFECT = 0.02;  // deviation of perfect planes that noise has to come to [voxels]
  typical_ = std::max(*middle, std::pow(PERFECT * scan.voxel_size, 2));
}

const Surfel& SurfaceModel::at(Eigen::Index n) {
  std::optional<Surfel>& piece = kept_[static_cast<std::size_t>(n)];
  if (!piece) piece = fit(n);
  return *piece;
}

Surfel SurfaceModel::fit(Eigen::Index n) {
  Surfel piece;
  const Eigen::Vector3f place = scan_.surface.col(n);
  piece.centre = place.cast<double>();
  piece.radius = RADIUS * scan_.voxel_size;
  for (int k = 0;; ++k, piece.radius *= WIDER) {
    search_->within(place, static_cast<float>(piece.radius), near_);
    if (near_.size() >= ENOUGH || k == WIDENINGS) break;
  }
  if (near_.size() < FEWEST) return piece;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Index m : near_) {
    const Eigen::Vector3d offset = (scan_.surface.col(m) - place).cast<double>() / piece.radius;
    sum += offset;
    squares += offset * offset.transpose();
  }
  const auto count = static_cast<double>(near_.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect((squares - sum * sum.transpose() / count) / count);
  const double scale = piece.radius * piece.radius;
  const double breadth = scale * solver.eigenvalues()[1];
  piece.centre += piece.radius * sum / count;
  piece.normal = solver.eigenvectors().col(0);
  piece.variance = scale * std::max(0.0, solver.eigenvalues()[0]);
  piece.is_valid = breadth > 0;
  if (piece.is_valid) piece.tilt = piece.variance / (breadth * count);
  piece.is_flat = piece.variance < FLAT * FLAT * breadth;
  return piece;
}

double SurfaceEvidence::share() const {
  const double all = agreeing.trace() + contradicting.trace();
  return all > 0 ? agreeing.trace() / all : 0;
}

double SurfaceEvidence::leastShare() const {
  constexpr double UNTOLD = 1e-6;  // of all that is told; less says nothing
  const Eigen::Matrix3d all = agreeing + contradicting;
  if (!(all.trace() > 0)) return 0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      agreeing, all + UNTOLD * all.trace() * Eigen::Matrix3d::Identity(), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0];
}

/// A piece of one scan, placed, and what the other scan has in its place.
struct SurfaceFit::Match {
  Eigen::Vector3d moving = Eigen::Vector3d::Zero();     ///< in the frame of the reference [m]
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< likewise
  Eigen::Vector3d normal;                               ///< of the piece, in the same frame...
  Eigen::Vector3d across;                               ///< ...and that across which they are compared
  double distance = 0;                                  ///< across [m]
  double variance = 0;                                  ///< that noise explains [m^2]
  double tilt = 0;                                      ///< variance of `across` by noise [rad^2]
  bool same_plane = true;        ///< false: both are flat, but face different ways: no measure of the pose
  bool has_counterpart = false;  ///< false: nothing like it is near
  bool is_moving = true;         ///< whether the piece is one of the moving scan
  Eigen::Vector3d placed;        ///< the piece in the frame of the other scan [m]

  bool agrees(double voxel) const {
    return has_counterpart && distance * distance < DEVIATIONS * DEVIATIONS * variance &&
           std::abs(distance) < FARTHEST * voxel;
  }
};

SurfaceFit::SurfaceFit(const ScanPair& pair)
    : pair_(pair),
      moving_(std::make_unique<SurfaceModel>(pair.movingScan(), pair.parameters().neighbours)),
      reference_(std::make_unique<SurfaceModel>(pair.referenceScan(), pair.parameters().neighbours)) {}

Eigen::Isometry3d SurfaceFit::approach(const Eigen::Isometry3d& start, double reach) const {
  constexpr std::size_t FEWEST_PULLS = 20;
  const double voxel = pair_.voxelSize();
  Eigen::Isometry3d pose = start * pair_.initialGuess();
  int last_steps = 0;
  for (int n = 0; n < STEPS + LAST_STEPS && last_steps < LAST_STEPS; ++n) {
    const std::size_t one_in = reach > NEAR_REACH * voxel ? ONE_IN : 2;
    std::vector<Pull> pulls;
    addPulls(*moving_, *reference_, pose, reach, one_in, pulls);
    const std::size_t forth = pulls.size();
    addPulls(*reference_, *moving_, pose.inverse(), reach, one_in, pulls);
    for (std::size_t k = forth; k < pulls.size(); ++k) {
      const Pull back = pulls[k];
      pulls[k] = {pose * back.reference, pose * back.moving,
                  pose.linear() * back.weight * pose.linear().transpose()};
    }
    if (pulls.size() < FEWEST_PULLS) break;
    const Eigen::Vector3d middle = middleOf(pulls);
    MotionFit fit(middle);
    for (const Pull& pull : pulls) fit.addToPoint(pull.moving, pull.reference, pull.weight);
    const Eigen::Isometry3d motion = fit.solve();
    pose = motion * pose;
    if (reach <= LAST_REACH * voxel) {
      ++last_steps;
      if ((motion * middle - middle).norm() + Eigen::AngleAxisd(motion.linear()).angle() * voxel <
          SETTLED * voxel)
        break;
    }
    reach = std::max(LAST_REACH * voxel, STEP * reach);
  }
  return pose * pair_.initialGuess().inverse();
}

void SurfaceFit::addMatches(SurfaceModel& from, SurfaceModel& to, const Eigen::Isometry3d& to_from,
                            Pieces pieces, std::vector<Match>& found) const {
  const double voxel = pair_.voxelSize();
  const std::size_t one_in = pieces == Pieces::ALL ? 1 : ONE_OF_FEW;
  for (std::size_t k = 0; k < from.sample().size(); k += one_in) {
    const Surfel& piece = from.at(from.sample()[k]);
    Match match;
    match.moving = to_from * piece.centre;
    match.normal = match.across = to_from.linear() * piece.normal;
    match.tilt = piece.tilt;
    match.variance = std::max(from.typicalVariance(), piece.variance) + to.typicalVariance();
    const double reach = std::max({REACH * voxel, piece.radius, to.view().spacingAt(match.moving)});
    const Neighbour nearest = to.nearest(match.moving, reach);
    if (nearest.index >= 0) {
      const Surfel& counterpart = to.at(nearest.index);
      const bool both_flat = piece.is_flat && counterpart.is_flat;
      if (counterpart.is_valid && (!both_flat || std::abs(match.normal.dot(counterpart.normal)) > ALIKE)) {
        match.has_counterpart = true;
        if (counterpart.is_flat) match.across = counterpart.normal, match.tilt = counterpart.tilt;
        if (both_flat) {
          const double cosine = match.normal.dot(counterpart.normal);
          match.across = (counterpart.normal + std::copysign(1.0, cosine) * match.normal).normalized();
          match.same_plane = std::abs(cosine) > SAME_PLANE;
        }
        match.reference = counterpart.centre;
        match.distance = match.across.dot(match.moving - match.reference);
        match.variance = std::max(from.typicalVariance(), piece.variance) +
                         std::max(to.typicalVariance(), counterpart.variance);
      }
    }
    found.push_back(match);
  }
}

std::vector<SurfaceFit::Match> SurfaceFit::matches(const Eigen::Isometry3d& correction, Pieces pieces) const {
  const Eigen::Isometry3d pose = correction * pair_.initialGuess();
  std::vector<Match> found;
  found.reserve(2 * static_cast<std::size_t>(SAMPLE));
  addMatches(*moving_, *reference_, pose, pieces, found);
  const std::size_t forth = found.size();
  addMatches(*reference_, *moving_, pose.inverse(), pieces, found);
  for (std::size_t n = 0; n < found.size(); ++n) {
    Match& match = found[n];
    match.is_moving = n < forth;
    match.placed = match.moving;
    if (match.is_moving) continue;
    const Eigen::Vector3d placed = match.moving;
    match.moving = pose * match.reference;
    match.reference = pose * placed;
    match.normal = pose.linear() * match.normal;
    match.across = -(pose.linear() * match.across);
  }
  return found;
}

IcpResult SurfaceFit::refine(const Eigen::Isometry3d& start, Pieces pieces) const {
  constexpr std::size_t FEWEST_MATCHES = 30;
  const std::size_t fewest = pieces == Pieces::ALL ? FEWEST_MATCHES : FEWEST_MATCHES / ONE_OF_FEW;
  const int most = pieces == Pieces::ALL ? REFINEMENTS : FEW_REFINEMENTS;
  const double voxel = pair_.voxelSize();
  const Blocks blocks(pair_.referenceScan().surface);
  IcpResult result;
  result.correction = start;
  for (int n = 0;; ++n) {
    const std::vector<Match> found = matches(result.correction, pieces);
    std::size_t count = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Match& match : found)
      if (match.has_counterpart) ++count, sum += match.reference;
    if (count < fewest) return result;
    result.centre = sum / static_cast<double>(count);
    std::vector<MotionFit> parts;
    MotionFit all(result.centre), by_noise(result.centre);
    double squares = 0, weights = 0;
    for (const Match& match : found) {
      if (!match.has_counterpart || !match.same_plane) continue;
      const double normalised = match.distance * match.distance / match.variance;
      const double inlier = peakOf(match.variance, voxel) * std::exp(-0.5 * normalised);
      const double weight = inlier / (inlier + OUTLIERS);
      const std::size_t block = blocks.of(match.reference);
      parts.resize(std::max(parts.size(), block + 1), MotionFit(result.centre));
      parts[block].addToPlane(match.moving, match.reference, match.across, weight / match.variance);
      // A plain would seem to be held sideways by the tilts that noise gives its pieces.
      const Eigen::Vector3d along = match.across.unitOrthogonal();
      for (const Eigen::Vector3d& tangent : {along, Eigen::Vector3d(match.across.cross(along))})
        by_noise.addToPlane(match.moving, match.reference, tangent, match.tilt * weight / match.variance);
      squares += weight * normalised;
      weights += weight;
    }
    for (const MotionFit& part : parts) all += part;
    result.information = all.information() - by_noise.information();
    result.variance = std::max(1.0, squares / weights);
    result.spread = jackknifeCovariance(parts);
    if (n == most) return result;
    const Eigen::Isometry3d motion = all.solve();
    result.correction = motion * result.correction;
    if (displacement(motion, Eigen::Isometry3d::Identity()) < SETTLED * voxel) return result;
  }
}

SurfaceEvidence SurfaceFit::at(const Eigen::Isometry3d& correction, Pieces pieces) const {
  const double voxel = pair_.voxelSize(), against = std::log(OUTLIERS);
  const std::vector<Match> found = matches(correction, pieces);
  SurfaceEvidence result;
  double seen[] = {0, 0}, looked_through[] = {0, 0};  // of the moving scan's pieces and of the reference's
  for (const Match& match : found) {
    const std::size_t scan = match.is_moving ? 0 : 1;
    const double peak = peakOf(match.variance, voxel), most = std::log(peak + OUTLIERS);
    if (!(most > 0)) continue;  // too rough to tell anything
    const Eigen::Matrix3d direction = match.normal * match.normal.transpose();
    if (match.agrees(voxel)) {
      const double normalised = match.distance * match.distance / match.variance;
      const double evidence = std::log(peak * std::exp(-0.5 * normalised) + OUTLIERS);
      result.evidence += evidence;
      result.agreeing += (evidence - against) * direction;
      result.contradicting += (most - evidence) * direction;
    } else {
      const Sight sight =
          (match.is_moving ? reference_ : moving_)->view().at(match.placed, SEEN_WITHIN * voxel);
      if (sight != Sight::EMPTY && sight != Sight::SURFACE) continue;
      result.evidence += against;
      result.contradicting += (most - against) * direction;
      if (sight == Sight::EMPTY) ++looked_through[scan];
    }
    ++seen[scan];
  }
  if (!found.empty()) result.seen = (seen[0] + seen[1]) / static_cast<double>(found.size());
  result.misplaced =
      std::min(looked_through[0] / std::max(1.0, seen[0]), looked_through[1] / std::max(1.0, seen[1]));
  return result;
}

double SurfaceFit::displacement(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
  constexpr Eigen::Index PLACES = 200;
  const Points places = evenSample(pair_.referenceScan().surface, PLACES);
  std::vector<double> distances;
  const Eigen::Isometry3d between = b * a.inverse();
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    const Eigen::Vector3d place = places.col(n).cast<double>();
    distances.push_back((between * place - place).norm());
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace pcl_fft_ground::core
