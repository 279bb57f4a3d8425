#include "files/shown_name.hpp"

#include <cstdint>

namespace flowdlo::files {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  // 0: no UTF-8
};

std::uint32_t byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

// The character that begins at `at`; overlong forms, surrogates and what ends early are none.
Character character_at(std::string_view text, std::size_t at) {
  const std::uint32_t first = byte_at(text, at);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || bytes > text.size() - at) return {};
  std::uint32_t code = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    const std::uint32_t next = byte_at(text, at + i);
    if ((next & 0xC0U) != 0x80) return {};
    code = code << 6U | (next & 0x3FU);
  }
  const bool overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
  if (overlong || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  return {code, bytes};
}

bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) ||  // C0, DEL, C1
         code == 0x061C || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) ||  // line and paragraph ends, directions
         (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::string_view text, bool lines_stay) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const Character next = character_at(text, at);
    const std::size_t bytes = next.bytes == 0 ? 1 : next.bytes;
    const bool stays = lines_stay && (next.code == '\n' || next.code == '\t') && next.bytes == 1;
    if (stays || (next.bytes > 0 && !is_control(next.code))) {
      result += text.substr(at, bytes);
    } else {
      for (std::size_t i = at; i < at + bytes; ++i) {
        const std::uint32_t byte = byte_at(text, i);
        result += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
      }
    }
    at += bytes;
  }
  return result;
}

}  // namespace

std::string shown(std::string_view text) { return escaped(text, false); }

std::string shown_lines(std::string_view text) { return escaped(text, true); }

}  // namespace flowdlo::files
