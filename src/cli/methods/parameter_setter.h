#pragma once

#include <pcl/exceptions.h>

#include <algorithm>
#include <array>
#include <boost/program_options.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "errors.h"

namespace pcl_fft_ground::cli {

/// How a switch is given.
constexpr std::array<std::pair<const char*, bool>, 2> SWITCH{{{"on", true}, {"off", false}}};

/// The value that a word stands for.
template <typename Value, std::size_t N>
Value valueNamed(const std::string& option, const std::string& word,
                 const std::array<std::pair<const char*, Value>, N>& names) {
  std::string allowed;
  for (const auto& [name, value] : names) {
    if (word == name) return value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(name);
  }
  throw UsageError("--" + option + " " + word + ": allowed is one of " + allowed);
}

/// The word that stands for a value; it must be one of them.
template <typename Value, std::size_t N>
std::string nameOf(Value value, const std::array<std::pair<const char*, Value>, N>& names) {
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == value; })->first;
}

/// Sets the parameters of one filter from the options and notes which value is in force, and why.
class ParameterSetter {
 public:
  ParameterSetter(const boost::program_options::variables_map& values, nlohmann::ordered_json& noted)
      : values_(values), noted_(noted) {}

  /// One that reads the same options and notes them elsewhere.
  ParameterSetter notingIn(nlohmann::ordered_json& noted) const { return {values_, noted}; }

  bool isGiven(const std::string& option) const {
    return values_.count(option) != 0 && !values_[option].defaulted();
  }

  /// Calls the setter if the option was given; its complaint becomes one about the option. Then notes the
  /// getter's value.
  template <typename Value, typename Set, typename Get>
  void set(const std::string& option, const Set& setter, const Get& getter) {
    const bool given = isGiven(option);
    try {
      if (given) setter(values_[option].as<Value>());
    } catch (const pcl::PCLException& problem) {
      const std::string message = problem.what();  // "Class: parameter is value, must be range"
      throw UsageError("--" + option + message.substr(message.rfind(": ")));
    }
    const auto value = getter();
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>)
      if (std::isnan(value)) return;  // not in force
    noted_[option] = {{"value", value}, {"from", given ? "option" : "default"}};
  }

  /// A count, read as a signed number because the parser would take -1 for the largest unsigned one.
  template <typename Set, typename Get>
  void setCount(const std::string& option, const Set& setter, const Get& getter) {
    set<long long>(
        option,
        [&](long long value) {
          if (value < 0 || value > 1000000000)
            throw UsageError("--" + option + " " + std::to_string(value) +
                             ": allowed is a whole number from 0 to 1e9");
          setter(static_cast<unsigned>(value));
        },
        getter);
  }

 private:
  const boost::program_options::variables_map& values_;
  nlohmann::ordered_json& noted_;
};

}  // namespace pcl_fft_ground::cli
