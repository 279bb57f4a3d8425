#include "png_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "frame/limits.hpp"

namespace flowdlo::fuzz {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkFrame = 12;  // length, type and checksum, four bytes each
constexpr std::size_t kHeaderEnd = 24;   // of signature, chunk head, width and height
constexpr std::uint64_t kMostPixels = 1U << 16U;

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

void mend_chunks(std::span<std::uint8_t> chunks) {
  while (chunks.size() >= kChunkFrame) {
    const std::size_t length = big_endian(chunks, 0);
    if (length > chunks.size() - kChunkFrame) return;
    const auto sum = crc32(0, chunks.data() + 4, static_cast<uInt>(length + 4));
    for (std::size_t i = 0; i < 4; ++i) {
      chunks[length + 8 + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    }
    chunks = chunks.subspan(length + kChunkFrame);
  }
}

}  // namespace

bool is_large_png(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderEnd) return false;
  const std::uint64_t width = big_endian(bytes, 16);
  const std::uint64_t height = big_endian(bytes, 20);
  return width <= frame::kMaxSide_px && height <= frame::kMaxSide_px &&
         width * height > kMostPixels;
}

void mend_png_checksums(std::span<std::uint8_t> bytes) {
  auto begin = bytes.begin();
  while (true) {
    begin = std::search(begin, bytes.end(), kSignature.begin(), kSignature.end());
    if (begin == bytes.end()) return;
    begin += kSignature.size();
    mend_chunks(bytes.subspan(static_cast<std::size_t>(begin - bytes.begin())));
  }
}

}  // namespace flowdlo::fuzz
