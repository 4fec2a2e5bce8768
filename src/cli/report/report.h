#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/// A report as JSON text, a line to each value. A file name that is no UTF-8 gets replacement characters.
std::string asText(const nlohmann::ordered_json& report);

/// A number that may be missing: null then.
nlohmann::ordered_json orNull(const std::optional<double>& value);

/// The three coordinates as a list.
std::vector<double> asList(const Eigen::Vector3d& place);

/// A matrix as a list of its rows.
nlohmann::ordered_json asRows(const Eigen::MatrixXd& matrix);

/// A number with a fixed count of decimals, a point as decimal mark in every locale.
std::string fixedNumber(double value, int decimals);

/// A whole number with a comma between thousands.
std::string groupedNumber(long long number);

/// The words one after the other. \param between what stands between two of them
std::string joined(const std::vector<std::string>& words, const std::string& between);

}  // namespace pcl_fft_ground::cli
