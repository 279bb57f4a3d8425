#include "frame/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/imgcodecs.hpp>

#include "frame/limits.hpp"

namespace flowdlo::frame {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkFrame = 12;  // length, type and checksum, four bytes each

std::uint32_t big_endian(Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t value = n;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1) ? 0xEDB88320U ^ value >> 1 : value >> 1;
    table[n] = value;
  }
  return table;
}

// CRC-32 as PNG has it (ISO 3309).
std::uint32_t crc(Bytes bytes) {
  static constexpr auto kTable = crc_table();
  std::uint32_t value = 0xFFFFFFFFU;
  for (const auto byte : bytes) value = kTable[(value ^ byte) & 0xFF] ^ value >> 8;
  return value ^ 0xFFFFFFFFU;
}

struct Size {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// The decoder behind OpenCV writes what it finds wrong to stderr and may return half an image, and
// a hostile header asks it for gigabytes. So the file's frame (sizes, chunks, checksums, end mark)
// is verified here. An empty string: whole.
std::string damage(Bytes bytes, Size& size) {
  if (bytes.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) {
    return "expected a PNG image, got another kind of file";
  }
  bool has_header = false;
  bool has_pixels = false;
  for (std::size_t at = kSignature.size(); at < bytes.size();) {
    if (bytes.size() - at < kChunkFrame) return "the PNG is cut short";
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - kChunkFrame) return "the PNG is cut short";
    const auto type = big_endian(bytes, at + 4);
    if (crc(bytes.subspan(at + 4, length + 4)) != big_endian(bytes, at + 8 + length)) {
      return "the PNG is damaged: a checksum does not fit";
    }
    if (!has_header) {
      if (type != 0x49484452U || length != 13) return "the PNG is damaged: it has no header";
      size = {big_endian(bytes, at + 8), big_endian(bytes, at + 12)};
      has_header = true;
    }
    has_pixels = has_pixels || type == 0x49444154U;                             // IDAT
    if (type == 0x49454E44U) return has_pixels ? "" : "the PNG has no pixels";  // IEND
    at += length + kChunkFrame;
  }
  return "the PNG is cut short";
}

}  // namespace

Result<cv::Mat> decode_png(Bytes bytes, const std::string& who) {
  Size size;
  const auto fault = damage(bytes, size);
  if (!fault.empty()) return Error{ErrorCode::kBadInput, who + ": " + fault + "; write it again"};
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide_px || size.height > kMaxSide_px) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected sides of 1 to {} px, got {} x {}; scale the images", who,
                             kMaxSide_px, size.width, size.height)};
  }
  try {
    const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8U,
                       const_cast<std::uint8_t*>(bytes.data()));  // only read
    cv::Mat image = cv::imdecode(view, cv::IMREAD_UNCHANGED);
    if (!image.empty()) return image;
  } catch (const cv::Exception&) {
    // told below: what OpenCV has to say helps nobody who made the file
  }
  return Error{ErrorCode::kBadInput, who + ": the PNG is damaged; write it again"};
}

Result<std::vector<std::uint8_t>> encode_png(const cv::Mat& image) {
  try {
    std::vector<std::uint8_t> bytes;
    if (cv::imencode(".png", image, bytes)) return bytes;
  } catch (const cv::Exception& failure) {
    return Error{ErrorCode::kInternal, std::string("encode_png: ") + failure.what()};
  }
  return Error{ErrorCode::kInternal, "encode_png: OpenCV could not encode the image"};
}

}  // namespace flowdlo::frame
