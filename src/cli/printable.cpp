#include "printable.h"

#include <array>
#include <cstdint>
#include <iostream>

namespace pcl_fft_ground::cli {
namespace {

/// A character of UTF-8 and the bytes that it takes.
struct Character {
  std::uint32_t code;
  std::size_t bytes;  ///< 0: the text does not begin with one
};

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// The first character. Only the shortest form of a code is one, and no half of a surrogate pair.
Character firstCharacter(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return {first, 0};
  std::uint32_t code = first & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return {first, 0};
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> LEAST{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < LEAST[bytes] || code > 0x10FFFF || is_surrogate) return {first, 0};
  return {code, bytes};
}

/// Control characters beyond ASCII, line and paragraph separators, marks of the direction of writing.
bool isHidden(std::uint32_t code) {
  return (code >= 0x80 && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF;
}

std::string hexadecimal(std::uint32_t code, std::size_t digits) {
  std::string text(digits, '0');
  for (std::size_t i = digits; i-- > 0; code >>= 4U) text[i] = "0123456789abcdef"[code & 0xFU];
  return text;
}

std::string escapedByte(unsigned char byte) {
  switch (byte) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return "\\x" + hexadecimal(byte, 2);
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto [code, bytes] = firstCharacter(text);
    if (bytes == 0 || code < 0x20 || code == 0x7F)
      result += escapedByte(static_cast<unsigned char>(text.front()));
    else if (isHidden(code))
      result += "\\u" + hexadecimal(code, 4);
    else
      result += text.substr(0, bytes);
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return result;
}

void printFault(std::string_view text) {
  std::cerr << "pcl_fft_ground: " << printable(text) << std::endl;
}

void printWarning(std::string_view text) {
  printFault("warning: " + std::string(text));
}

}  // namespace pcl_fft_ground::cli
