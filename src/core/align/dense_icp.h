#pragma once

#include "align/scan_pair.h"
#include "pcl_fft_ground/core/align/dense_alignment.h"

namespace pcl_fft_ground::core {

/// Dense ICP of a pair, gated, see alignDensely() of scans.
Alignment alignDensely(const ScanPair& pair, DensePoints which);

}  // namespace pcl_fft_ground::core
