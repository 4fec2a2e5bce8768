#pragma once

#include <Eigen/Core>
#include <string>

namespace pcl_fft_ground::cli {

/// Writes a map of heights as an ESRI ASCII grid, which GIS programs read; whole or not at all.
/// \param heights            heights(i, j) [m] of the cell at x = corner.x + (i + 1/2) cell_size, y =
///         corner.y + (j + 1/2) cell_size; anything not finite is "no data" (-9999). Written to 0.1 mm; a
///         height of -9999 itself comes out 0.1 mm higher
/// \param lower_left_corner  outer corner of the cell (0, 0) [m], written with all its digits
/// \param cell_size          [m], above 0
/// \throws WorkError naming the file if it cannot be written
/// \throws std::invalid_argument for no cells, a corner that is not finite or a cell size that is not above
///         0
void writeAsciiGrid(const std::string& path, const Eigen::ArrayXXd& heights,
                    const Eigen::Vector2d& lower_left_corner, double cell_size);

}  // namespace pcl_fft_ground::cli
