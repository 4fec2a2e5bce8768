#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The lines of a text file and the values in them.
namespace pcl_fft_ground::cli {

using Values = std::vector<std::string_view>;

/// What commas mean in the lines of a file.
enum class Comma { SEPARATOR, DECIMAL };

bool isDigit(char c);
bool isQuote(char c);
std::string lowered(std::string_view text);

/// Takes the first value off a line, with its quotes off, and the one separator behind it; so `1,,2` has an
/// empty value.
std::string_view takeValue(std::string_view& line, Comma comma);

/// The values of a line; a separator behind the last one is none of its own.
Values splitValues(std::string_view line, Comma comma);
bool endsWithSeparator(std::string_view line);

/// A number, maybe with one decimal comma.
std::optional<double> parseReal(std::string_view text);

/// The lines of a text, whether LF, CR LF or CR ends them.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// The next line that has more than blanks; empty at the end.
  std::string_view next();

  /// As next(), without comments.
  std::string_view nextData();

  std::size_t number() const { return number_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// What a line with commas or semicolons says about commas: decimal where semicolons part the values, and
/// where blanks do and no value has more than one comma, between digits.
Comma meaningOfCommas(std::string_view line);
/// The same by the first such line, from `first` on.
Comma meaningOfCommas(std::string_view first, Lines later);

}  // namespace pcl_fft_ground::cli
