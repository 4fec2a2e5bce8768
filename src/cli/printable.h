#pragma once

#include <string>
#include <string_view>

namespace pcl_fft_ground::cli {

/** A text as a terminal may show it, on one line, whatever a file or its name brought: escaped as in C (\n,
 * \x1b, \xff) stand the control characters and all bytes that are no UTF-8; as \u009b the control characters
 * above ASCII and those that part lines or turn the direction of writing. Everything else stays as it is,
 * backslashes too.
 */
std::string printable(std::string_view text);

/// Prints a line on the standard error, escaped: "pcl_fft_ground: " and the text.
void printFault(std::string_view text);

/// Prints a warning in the same way.
void printWarning(std::string_view text);

}  // namespace pcl_fft_ground::cli
