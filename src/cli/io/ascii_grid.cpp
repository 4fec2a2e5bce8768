#include "io/raster_files.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "io/output_file.h"

namespace pcl_fft_ground::cli {
namespace {

constexpr int height_digits = 4;  // 0.1 mm
constexpr double no_data = -9999.0;

/// A double without exponent, shortest as to_chars has it, may need 308 digits before or 1074 after the
/// point.
using NumberText = std::array<char, 1100>;

/// All digits of a number, never with an exponent (some readers of the format know none).
std::string exact(double number) {
  NumberText text;
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed).ptr};
}

void appendHeight(std::string& content, double height) {
  if (!std::isfinite(height)) {
    content += "-9999";
    return;
  }
  const bool looks_like_no_data = std::abs(height - no_data) < 0.5e-4;
  NumberText text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), looks_like_no_data ? no_data + 1e-4 : height,
                    std::chars_format::fixed, height_digits);
  content.append(text.data(), end.ptr);
}

}  // namespace

void writeAsciiGrid(const std::string& path, const Eigen::ArrayXXd& heights,
                    const Eigen::Vector2d& lower_left_corner, double cell_size) {
  if (heights.size() == 0 || !lower_left_corner.allFinite() || !(cell_size > 0.0) ||
      !std::isfinite(cell_size)) {
    throw std::invalid_argument("an ASCII grid needs cells, a finite corner and a cell size above 0");
  }
  std::string content = "ncols " + std::to_string(heights.rows()) + "\nnrows " +
                        std::to_string(heights.cols()) + "\nxllcorner " + exact(lower_left_corner.x()) +
                        "\nyllcorner " + exact(lower_left_corner.y()) + "\ncellsize " + exact(cell_size) +
                        "\nNODATA_value -9999\n";
  for (Eigen::Index y = heights.cols() - 1; y >= 0; --y) {  // the first row is the northernmost
    for (Eigen::Index x = 0; x < heights.rows(); ++x) {
      if (x != 0) content += ' ';
      appendHeight(content, heights(x, y));
    }
    content += '\n';
  }
  writeText(path, content);
}

}  // namespace pcl_fft_ground::cli
