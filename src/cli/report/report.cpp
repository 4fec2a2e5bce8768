#include "report/report.h"

#include <locale>
#include <sstream>

namespace pcl_fft_ground::cli {

using nlohmann::ordered_json;

std::string asText(const ordered_json& report) {
  // JSON may hold DEL and the control characters above ASCII as they are; a terminal would obey them.
  const std::string text = report.dump(2, ' ', false, ordered_json::error_handler_t::replace);
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    if (byte == 0x7F) {
      result += "\\u007f";
    } else if (byte == 0xC2 && next < 0xA0) {
      result += std::string("\\u00") + "89"[next >= 0x90] + "0123456789abcdef"[next & 0xFU];
      ++i;
    } else {
      result += text[i];
    }
  }
  return result + "\n";
}

ordered_json orNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

std::vector<double> asList(const Eigen::Vector3d& place) {
  return {place.x(), place.y(), place.z()};
}

ordered_json asRows(const Eigen::MatrixXd& matrix) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(row);
  }
  return rows;
}

std::string fixedNumber(double value, int decimals) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.setf(std::ios::fixed);
  text.precision(decimals);
  text << value;
  return text.str();
}

std::string groupedNumber(long long number) {
  std::string digits = std::to_string(number);
  const std::ptrdiff_t first = number < 0 ? 1 : 0;
  for (auto position = static_cast<std::ptrdiff_t>(digits.size()) - 3; position > first; position -= 3)
    digits.insert(static_cast<std::size_t>(position), ",");
  return digits;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace pcl_fft_ground::cli
