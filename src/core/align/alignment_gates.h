#pragma once

#include <optional>
#include <string>

#include "align/icp.h"
#include "align/scan_pair.h"

namespace pcl_fft_ground::core {

/// Covariance of an alignment for motions about the centre of the ICP's points; nothing if they do not hold
/// it.
std::optional<Matrix6d> covarianceAboutCentre(const IcpResult& icp);

/// Why a correction of the initial guess is larger than it may be; empty if it is not.
std::string reasonAgainstMotion(const ScanPair& pair, const IcpResult& icp);

/// Why a correction of the initial guess is not to be believed, by its size, its predicted error and what is
/// left of the distances; empty if it is.
std::string reasonAgainst(const ScanPair& pair, const IcpResult& icp);

/// The initial guess as it is, and why.
Alignment refused(const ScanPair& pair, const std::string& reason);

/// The result with what every method reports: transform, covariance, overlap.
Alignment alignmentOf(const ScanPair& pair, const IcpResult& icp, AlignmentMethod method);

}  // namespace pcl_fft_ground::core
