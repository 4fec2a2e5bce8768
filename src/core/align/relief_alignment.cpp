#include "pcl_fft_ground/core/align/relief_alignment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "align/relief_icp.h"
#include "align/relief_search.h"
#include "pcl_fft_ground/core/scan/frame.h"
#include "pcl_fft_ground/core/scan/point_statistics.h"
#include "pcl_fft_ground/core/scan/prepare.h"
#include "scan/parameter_check.h"

namespace pcl_fft_ground::core {
namespace {

constexpr double PI = 3.14159265358979323846;

constexpr double DEGREE = PI / 180;

// The constants of relief alignment.
constexpr double CELL = 2.4;              // side of the finest cells [spacings]: some six points
constexpr double MOST_CELLS = 400;        // along a side of the finest grid; larger scans get larger cells
constexpr double MOST_SEARCHED = 1000;    // the same with all that navigation allows around it
constexpr double FEWEST_CELLS = 16;       // along the shorter side of the coarsest grid
constexpr std::size_t MOST_SCALES = 3;    // each with cells twice as large
constexpr std::size_t PEAKS = 5;          // of each scale from which ICP starts
constexpr int AROUND = 8;                 // starts of ICP around the guess...
constexpr double HALF_WAY = 0.6;          // ...so far out, of what navigation allows
constexpr double SETTLED = 1e-3;          // a smaller step of ICP is the last [spacings]
constexpr double CORRELATED = 3;          // by which neighbouring heights share their errors
constexpr double SLACK = 1.15;            // the last refinement may leave the bounds by so much
constexpr double SAME = 0.5;              // poses that meet nearer than this are one [finest cells]
constexpr double LEAST_OVERLAP = 0.10;    // share of the smaller scan
constexpr double LARGEST_RESIDUAL = 1.0;  // in units of what noise and roughness explain
constexpr double LEAST_EVIDENCE = 3;      // a twentieth of a chance pose as good among all that were tried
constexpr double SURER = 0.15;            // deviation of the turn, of what navigation allows
constexpr double LEAST_LEAD = 3;          // in evidence, over any rival whose surfaces fit, too
constexpr double NEARLY_FITS = 1.15;      // residual of a rival, in the same units or over that of the best
// A pattern that repeats correlates as well one pitch away; that less of it overlaps there says nothing.
constexpr double AS_WELL = 0.9;            // of the best one's correlation makes a rival that fits one...
constexpr double AS_MUCH = 0.5;            // ...if it overlaps by so much of what the best one does
constexpr double LARGEST_DEVIATION = 0.4;  // predicted at the edge of the overlap [spacings]

void check(const Eigen::Isometry3d& guess, const ReliefParameters& p) {
  const auto positive = [](const char* name, double value) {
    require(std::isfinite(value) && value > 0, name, value, "a finite number above 0");
  };
  positive("max_shift", p.gates.max_shift);
  positive("max_rise", p.gates.max_rise);
  positive("max_tilt", p.gates.max_tilt);
  positive("cell_size", p.cell_size.value_or(1));
  positive("max_sigma", p.max_sigma.value_or(1));
  require(p.gates.max_turn > 0 && p.gates.max_turn <= 180, "max_turn", p.gates.max_turn,
          "above 0 to 180 degrees");
  if (!guess.matrix().allFinite()) throw std::invalid_argument("the initial guess is not finite");
}

std::string sentence(const char* what, double value, const char* than, double allowed, const char* unit) {
  std::ostringstream text;
  text << std::setprecision(3) << what << " is " << value << unit << ", " << than << " " << allowed << unit;
  return text.str();
}

/// Amid what both bounding boxes share, or amid the moving one.
Eigen::Vector2d pivotOf(const Points& moving, const Points& reference) {
  const Bounds a = boundsOf(moving), b = boundsOf(reference);
  const Eigen::Array2d low = a.low.head<2>().max(b.low.head<2>()),
                       high = a.high.head<2>().min(b.high.head<2>());
  if ((low < high).all()) return 0.5 * (low + high);
  return 0.5 * (a.low + a.high).head<2>();
}

/// A pose that ICP has come to.
struct Candidate {
  ReliefFit fit;
  ReliefAgreement agreement;
};

class ReliefPair {
 public:
  ReliefPair(const Points& moving, const Points& reference, const ReliefParameters& parameters)
      : parameters_(parameters),
        moving_(moving),
        reference_(reference),
        spacing_(std::max(planSpacing(moving), planSpacing(reference))),
        moving_scan_(reliefScan(moving, spacing_)),
        reference_scan_(reliefScan(reference, spacing_)),
        bounds_{pivotOf(moving, reference), parameters.gates.max_shift, parameters.gates.max_turn * DEGREE},
        cell_(finestCell()) {}

  double spacing() const { return spacing_; }
  double cellSize() const { return cell_; }

  std::vector<Candidate> candidates() {
    const ReliefIcp icp(moving_scan_, reference_scan_, SETTLED * spacing_);
    std::vector<Eigen::Isometry3d> starts = blindStarts();
    double cell = cell_;
    for (std::size_t scale = 0; scale < MOST_SCALES; ++scale, cell *= 2) {
      if (scale > 0 && shorterSide() < FEWEST_CELLS * cell) break;
      searches_.emplace_back(moving_, reference_, bounds_, cell);
      for (const ReliefPeak& peak : searches_.back().peaks(PEAKS)) starts.push_back(peak.correction);
    }
    std::vector<Candidate> found;
    for (const Eigen::Isometry3d& start : starts) {
      const ReliefFit fit = icp.run(start);
      if (fit.samples < 1 || fit.information.isZero(0)) continue;
      const bool known = std::any_of(found.begin(), found.end(), [&](const Candidate& other) {
        return displacement(fit, other.fit.correction) < SAME * cell_;
      });
      if (known) continue;
      found.push_back({fit, agreementAt(fit.correction)});
      double& evidence = found.back().agreement.evidence;
      evidence = std::max(evidence, evidenceOf(fit));
    }
    return found;
  }

  /// Largest displacement of the overlap of a fit under another correction [m].
  static double displacement(const ReliefFit& fit, const Eigen::Isometry3d& other) {
    const Eigen::Isometry3d between = other * fit.correction.inverse();
    return (between * fit.centre - fit.centre).norm() +
           Eigen::AngleAxisd(between.linear()).angle() * fit.radius;
  }

  /// Empty if a correction is within what navigation allows.
  std::string reasonAgainstMotion(const ReliefFit& fit) const {
    const SearchGates& gates = parameters_.gates;
    const Eigen::Vector3d moved = fit.centre - fit.correction.inverse() * fit.centre;
    const double turn = std::abs(yawOf(fit.correction)) / DEGREE, tilt = tiltOf(fit.correction) / DEGREE;
    if (moved.head<2>().norm() > SLACK * gates.max_shift)
      return sentence("the shift", moved.head<2>().norm(), "allowed are", SLACK * gates.max_shift, " m");
    if (std::abs(moved.z()) > SLACK * gates.max_rise)
      return sentence("the rise", std::abs(moved.z()), "allowed are", SLACK * gates.max_rise, " m");
    if (turn > SLACK * gates.max_turn)
      return sentence("the turn", turn, "allowed are", SLACK * gates.max_turn, " degrees");
    if (tilt > gates.max_tilt) return sentence("the tilt", tilt, "allowed are", gates.max_tilt, " degrees");
    return {};
  }

  /// How much likelier what is left between the surfaces is than between unrelated ones, as
  /// ReliefPose::evidence has it: relief of long waves, of which few cells tell, speaks by this.
  double evidenceOf(const ReliefFit& fit) const {
    constexpr double FITTED = 3;  // shift and turn: rise and tilt are not counted as relief
    if (!(fit.patch > 0 && fit.residual > 0)) return 0;
    const double places =
        std::pow(bounds_.shift / fit.patch, 2) * (1 + 2 * bounds_.turn * fit.radius / fit.patch);
    const double independent = std::max(0.0, fit.patches - FITTED);
    return independent * std::log(fit.relief / fit.residual) - std::log(std::max(1.0, places));
  }

 private:
  /// The guess, and others around it: where relief is long and overlaps are small the grids tell little.
  std::vector<Eigen::Isometry3d> blindStarts() const {
    std::vector<Eigen::Isometry3d> starts{Eigen::Isometry3d::Identity()};
    for (int k = 0; k < AROUND; ++k) {
      const double angle = 2 * PI * k / AROUND, shift = HALF_WAY * bounds_.shift;
      starts.emplace_back(Eigen::Translation3d(shift * std::cos(angle), shift * std::sin(angle), 0));
    }
    return starts;
  }

  double shorterSide() const {
    const Bounds a = boundsOf(moving_), b = boundsOf(reference_);
    return std::min((a.high - a.low).head<2>().minCoeff(), (b.high - b.low).head<2>().minCoeff());
  }

  double finestCell() const {
    const Bounds a = boundsOf(moving_), b = boundsOf(reference_);
    const double side =
        std::min((a.high - a.low).head<2>().maxCoeff(), (b.high - b.low).head<2>().maxCoeff());
    const double searched = (side + 2 * bounds_.shift) / MOST_SEARCHED;
    return std::max({parameters_.cell_size.value_or(CELL * spacing_), side / MOST_CELLS, searched});
  }

  /// By the scale that tells most.
  ReliefAgreement agreementAt(const Eigen::Isometry3d& correction) const {
    ReliefAgreement best;
    bool first = true;
    for (const ReliefSearch& search : searches_) {
      const ReliefAgreement agreement = search.at(correction);
      if (first || agreement.evidence > best.evidence) best = agreement;
      first = false;
    }
    return best;
  }

  const ReliefParameters& parameters_;
  const Points& moving_;
  const Points& reference_;
  double spacing_;
  ReliefScan moving_scan_, reference_scan_;
  ReliefBounds bounds_;
  double cell_;
  std::vector<ReliefSearch> searches_;
};

/// Covariance of a fit for motions about its centre; nothing if it leaves a direction free.
std::optional<Matrix6d> covarianceOf(const ReliefFit& fit) {
  constexpr double UNHELD = 1e-9;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(fit.information);
  const Vector6d values = solver.eigenvalues();
  if (!(values[0] > UNHELD * values[5])) return std::nullopt;
  const double variance = CORRELATED * std::max(1.0, fit.residual * fit.residual);
  const Matrix6d of_noise = variance * solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
                            solver.eigenvectors().transpose();
  return Matrix6d(of_noise + fit.spread);
}

double largestTurn(const Matrix6d& covariance) {
  const Eigen::Matrix3d turns = covariance.bottomRightCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(turns, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

/// Empty if the best pose is to be believed.
std::string reasonAgainst(const ReliefResult& result, const ReliefParameters& parameters) {
  const SearchGates& gates = parameters.gates;
  const ReliefPose& best = result.best;
  if (best.residual > LARGEST_RESIDUAL)
    return sentence("what is left between the surfaces", best.residual, "allowed are", LARGEST_RESIDUAL,
                    " of what is expected");
  if (best.evidence < LEAST_EVIDENCE)
    return sentence("the evidence of the relief", best.evidence, "needed are", LEAST_EVIDENCE, "");
  const double allowed = LARGEST_DEVIATION * result.spacing;
  const double most = std::min(allowed, parameters.max_sigma.value_or(allowed));
  if (result.deviation > most)
    return sentence("the predicted deviation at the edge of the overlap", result.deviation, "allowed are",
                    most, " m");
  const double turn = largestTurn(result.covariance) / DEGREE, most_turn = SURER * gates.max_turn;
  if (turn > most_turn)
    return sentence("the predicted deviation of the turn", turn, "allowed are", most_turn, " degrees");
  for (const ReliefPose& rival : result.rivals) {
    const bool fits = rival.residual < NEARLY_FITS * std::min(1.0, best.residual);
    const bool better = rival.residual < best.residual && rival.evidence > 0;
    const bool repeats =
        rival.correlation > AS_WELL * best.correlation && rival.overlap > AS_MUCH * best.overlap;
    if (better || (fits && (repeats || rival.evidence > best.evidence - LEAST_LEAD)))
      return sentence("the relief fits as well elsewhere: the evidence", best.evidence, "there it is",
                      rival.evidence, "");
  }
  return {};
}

}  // namespace

ReliefResult alignRelief(const PointsView& moving, const PointsView& reference,
                         const Eigen::Isometry3d& initial_guess, const ReliefParameters& parameters) {
  check(initial_guess, parameters);
  ReliefResult result;
  result.reference_from_moving = initial_guess;
  const Points below = usablePoints(reference).points;
  const Points above = transformed(usablePoints(moving).points, initial_guess);
  if (!(planSpacing(below) > 0 && planSpacing(above) > 0)) {
    result.refusal = "a scan has no extent";
    return result;
  }
  ReliefPair pair(above, below, parameters);
  result.spacing = pair.spacing();
  result.cell_size = pair.cellSize();
  std::vector<Candidate> candidates = pair.candidates();
  std::string reason = "hardly any overlap";
  const auto outside = [&](const Candidate& candidate) {
    const std::string why = pair.reasonAgainstMotion(candidate.fit);
    if (!why.empty()) reason = why;
    return !why.empty() || candidate.fit.overlap < LEAST_OVERLAP;
  };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), outside), candidates.end());
  if (candidates.empty()) {
    result.refusal = reason;
    return result;
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.agreement.evidence > b.agreement.evidence;
  });
  const Candidate& best = candidates.front();
  for (const Candidate& candidate : candidates) {
    ReliefPose pose;
    pose.reference_from_moving = candidate.fit.correction * initial_guess;
    pose.overlap = candidate.fit.overlap;
    pose.residual = candidate.fit.residual;
    pose.correlation = candidate.agreement.correlation;
    pose.evidence = candidate.agreement.evidence;
    if (&candidate == &best) {
      result.best = pose;
      continue;
    }
    pose.distance = ReliefPair::displacement(best.fit, candidate.fit.correction);
    result.rivals.push_back(pose);
  }
  const std::optional<Matrix6d> covariance = covarianceOf(best.fit);
  if (!covariance) {
    result.refusal = "the relief leaves a direction free";
    return result;
  }
  result.covariance = covarianceAboutOrigin(*covariance, best.fit.centre);
  result.deviation = deviationAtDistance(*covariance, best.fit.radius);
  result.refusal = reasonAgainst(result, parameters);
  if (!result.refusal.empty()) return result;
  result.accepted = true;
  result.reference_from_moving = result.best.reference_from_moving;
  return result;
}

}  // namespace pcl_fft_ground::core
