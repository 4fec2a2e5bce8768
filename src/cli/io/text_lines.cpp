#include "io/text_lines.h"

#include <cctype>

#include "io/scanner.h"

namespace pcl_fft_ground::cli {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool isQuote(char c) {
  return c == '"' || c == '\'';
}

std::string lowered(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string_view takeValue(std::string_view& line, Comma comma) {
  const auto separates = [&](char c) { return c == ';' || (c == ',' && comma == Comma::SEPARATOR); };
  std::string_view value;
  const std::size_t closing = isQuote(line.front()) ? line.find(line.front(), 1) : std::string_view::npos;
  if (closing != std::string_view::npos) {
    value = line.substr(1, closing - 1);
    line.remove_prefix(closing + 1);
  } else {
    std::size_t length = 0;
    while (length < line.size() && !isBlank(line[length]) && !separates(line[length])) ++length;
    value = line.substr(0, length);
    line.remove_prefix(length);
  }
  skipBlanks(line);
  if (!line.empty() && separates(line.front())) line.remove_prefix(1);
  skipBlanks(line);
  return value;
}

Values splitValues(std::string_view line, Comma comma) {
  Values values;
  skipBlanks(line);
  while (!line.empty()) values.push_back(takeValue(line, comma));
  return values;
}

bool endsWithSeparator(std::string_view line) {
  while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
  return !line.empty() && (line.back() == ',' || line.back() == ';');
}

std::optional<double> parseReal(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return parseNumber<double>(text);
  if (text.find('.') != std::string_view::npos) return std::nullopt;
  std::string with_point(text);
  with_point[comma] = '.';
  return parseNumber<double>(with_point);
}

std::string_view Lines::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find_first_of("\r\n");
    std::string_view line = rest_.substr(0, end);
    const bool both = end != std::string_view::npos && rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + (both ? 2 : 1));
    ++number_;
    skipBlanks(line);
    if (!line.empty()) return line;
  }
  return {};
}

std::string_view Lines::nextData() {
  for (std::string_view line = next(); !line.empty(); line = next())
    if (const std::string_view data = line.substr(0, line.find('#')); !data.empty()) return data;
  return {};
}

Comma meaningOfCommas(std::string_view line) {
  while (!line.empty() && (isBlank(line.back()) || line.back() == ';' || line.back() == ','))
    line.remove_suffix(1);
  if (line.find(';') != std::string_view::npos) return Comma::DECIMAL;
  std::size_t words = 0, with_comma = 0;
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line), ++words) {
    const std::size_t comma = word.find(',');
    if (comma == std::string_view::npos) continue;
    const bool decimal = comma > 0 && comma + 1 < word.size() && isDigit(word[comma + 1]) &&
                         (isDigit(word[comma - 1]) || word[comma - 1] == '-') &&
                         word.find(',', comma + 1) == std::string_view::npos;
    if (!decimal) return Comma::SEPARATOR;
    ++with_comma;
  }
  return words >= 3 && with_comma > 0 ? Comma::DECIMAL : Comma::SEPARATOR;
}

Comma meaningOfCommas(std::string_view first, Lines later) {
  for (std::string_view line = first; !line.empty(); line = later.nextData())
    if (line.find_first_of(",;") != std::string_view::npos) return meaningOfCommas(line);
  return Comma::SEPARATOR;
}

}  // namespace pcl_fft_ground::cli
