#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "printable.h"

namespace pcl_fft_ground::cli {

/// Takes the first line off `text` and returns it without its line end (LF or CR LF).
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Takes the blanks off the front of `text`.
inline void skipBlanks(std::string_view& text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
}

/// Takes the first word, as blanks part them, off `text`; empty if there is none left.
inline std::string_view takeWord(std::string_view& text) {
  skipBlanks(text);
  std::size_t length = 0;
  while (length < text.size() && !isBlank(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

/// The whole of `text` as a number, whatever the locale; for floating types `nan` and `inf` are numbers
/// too. Nothing if it is anything else, or out of the type's range.
template <typename Number>
std::optional<Number> parseNumber(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
  return number;
}

/// `text` in quotes, fit for a message: cut to a readable length and escaped.
inline std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;
  return "'" + printable(text.substr(0, longest)) + (text.size() > longest ? "...'" : "'");
}

}  // namespace pcl_fft_ground::cli
