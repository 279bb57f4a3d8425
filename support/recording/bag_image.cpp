#include "recording/bag_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>

#include "frame/limits.hpp"
#include "frame/png.hpp"
#include "png_picture.hpp"
#include "recording/jpeg.hpp"

namespace flowdlo::recording {
namespace {

using support::Picture;
using Depth = image::Image<float>;
using Grey = image::Image<std::uint8_t>;

constexpr double kMetresAMillimetre = 0.001;
constexpr std::size_t kDepthHeaderBytes = 12;  // compressedDepth: format, quantisation a and b

Error bad(const std::string& who, const std::string& expected, const std::string& got) {
  return {ErrorCode::kBadInput, fmt::format("{}: expected {}, got {}", who, expected, got)};
}

/// A copy without padding. Every value of a Pixel is one of the message's.
template <class Pixel>
Result<image::Image<Pixel>> raw_pixels(const ImageMessage& message, const std::string& who) {
  const std::size_t row_bytes = sizeof(Pixel) * message.width;
  const std::size_t step = message.step;
  const auto side = static_cast<std::uint32_t>(frame::kMaxSide_px);
  if (message.width < 1 || message.height < 1 || message.width > side || message.height > side) {
    return bad(who, fmt::format("1 to {} px a side", side),
               fmt::format("{} x {}", message.width, message.height));
  }
  if (step < row_bytes || message.data.size() < step * (message.height - 1) + row_bytes) {
    return bad(who,
               fmt::format("{} x {} px of {}", message.width, message.height, message.encoding),
               fmt::format("{} bytes in rows of {}", message.data.size(), message.step));
  }
  image::Image<Pixel> pixels(
      image::Size{static_cast<int>(message.width), static_cast<int>(message.height)});
  for (int v = 0; v < pixels.height(); ++v) {
    std::memcpy(pixels.row(v), message.data.data() + static_cast<std::size_t>(v) * step, row_bytes);
  }
  return pixels;
}

/// Of pixels of kChannels bytes: which of them are blue, green and red.
template <std::size_t kChannels, std::size_t kBlue, std::size_t kGreen, std::size_t kRed>
Result<Picture> raw_color(const ImageMessage& message, const std::string& who) {
  const auto pixels = raw_pixels<std::array<std::uint8_t, kChannels>>(message, who);
  if (!pixels) return pixels.error();
  Picture color(pixels->size());
  for (std::size_t i = 0; i < color.total(); ++i) {
    const auto& pixel = pixels->data()[i];
    color.data()[i] = {pixel[kBlue], pixel[kGreen], pixel[kRed]};
  }
  return color;
}

using ReadColor = Result<Picture> (*)(const ImageMessage& message, const std::string& who);

const std::map<std::string, ReadColor>& color_kinds() {
  static const std::map<std::string, ReadColor> kinds{
      {"rgb8", raw_color<3, 2, 1, 0>},  {"bgr8", raw_color<3, 0, 1, 2>},
      {"8UC3", raw_color<3, 0, 1, 2>},  {"rgba8", raw_color<4, 2, 1, 0>},
      {"bgra8", raw_color<4, 0, 1, 2>}, {"8UC4", raw_color<4, 0, 1, 2>},
      {"mono8", raw_color<1, 0, 0, 0>}, {"8UC1", raw_color<1, 0, 0, 0>}};
  return kinds;
}

template <class Value>
void swap_bytes(image::Image<Value>& pixels) {
  for (std::size_t i = 0; i < pixels.total(); ++i) {
    auto* const first = reinterpret_cast<std::byte*>(pixels.data() + i);
    std::reverse(first, first + sizeof(Value));
  }
}

Error no_picture(const ImageMessage& message, const std::string& who) {
  return bad(
      who, fmt::format("a JPEG or PNG of at most {} px a side", frame::kMaxSide_px),
      fmt::format("{} bytes of format \"{}\" that are none", message.data.size(), message.format));
}

Result<Picture> decoded_color(const ImageMessage& message, const std::string& who) {
  if (const auto png = frame::decode_png(message.data, who)) return support::picture_of(*png);
  auto picture = decode_jpeg(message.data, frame::kMaxSide_px);
  if (picture.empty()) return no_picture(message, who);
  return picture;
}

Result<Grey> decoded_grey(const ImageMessage& message, const std::string& who) {
  if (const auto png = frame::decode_png(message.data, who)) return support::grey_image_of(*png);
  auto picture = decode_grey_jpeg(message.data, frame::kMaxSide_px);
  if (picture.empty()) return no_picture(message, who);
  return picture;
}

/// What each of a depth image's values is in metres.
template <class Metres>
Depth depth_of(std::span<const std::uint16_t> values, const image::Size& size, Metres metres) {
  Depth depth_m(size);
  std::transform(values.begin(), values.end(), depth_m.data(), metres);
  return depth_m;
}

// Rounded once, as for the depth.png of a frame folder: the same frame gives the same bits.
Depth metres_of(std::span<const std::uint16_t> millimetres, const image::Size& size) {
  return depth_of(millimetres, size, [](std::uint16_t value) {
    return static_cast<float>(value * kMetresAMillimetre);
  });
}

// depth = a / (value - b), 0 stays none: how compressedDepth packs floats into 16 bits.
Depth unpacked(std::span<const std::uint16_t> values, const image::Size& size,
               std::span<const std::uint8_t> header) {
  float a = 0;
  float b = 0;
  std::memcpy(&a, header.data() + sizeof(std::int32_t), sizeof(a));
  std::memcpy(&b, header.data() + sizeof(std::int32_t) + sizeof(a), sizeof(b));
  return depth_of(values, size, [a, b](std::uint16_t value) {
    return value == 0 ? 0.0F : a / (static_cast<float>(value) - b);
  });
}

Result<Depth> compressed_depth(const ImageMessage& message, const std::string& who) {
  const std::string encoding = message.format.substr(0, message.format.find(';'));
  const bool packed = message.format.find("compressedDepth") != std::string::npos;
  std::span<const std::uint8_t> bytes(message.data);
  if (message.format.find("rvl") != std::string::npos ||
      (packed && encoding != "16UC1" && encoding != "mono16" && encoding != "32FC1")) {
    return bad(who, "compressedDepth of 16UC1 or 32FC1 as PNG", message.format);
  }
  std::span<const std::uint8_t> header;
  if (packed) {
    if (bytes.size() < kDepthHeaderBytes) return bad(who, "compressedDepth", "too few bytes");
    header = bytes.first(kDepthHeaderBytes);
    bytes = bytes.subspan(kDepthHeaderBytes);
  }
  constexpr const char* kExpected = "depth as a 16-bit PNG of 1 channel";
  const auto picture = frame::decode_png(bytes, who);
  if (!picture) return bad(who, kExpected, fmt::format("{} bytes that are no PNG", bytes.size()));
  const frame::PngFormat& format = picture->format();
  if (format.bits != 16 || format.channels != 1) {
    return bad(who, kExpected, fmt::format("{}-bit, {} channels", format.bits, format.channels));
  }
  const auto values = picture->values<std::uint16_t>();
  const image::Size size{format.width, format.height};
  return packed && encoding == "32FC1" ? unpacked(values, size, header) : metres_of(values, size);
}

}  // namespace

Result<Picture> color_image(const ImageMessage& message, const std::string& who) {
  if (message.compressed) return decoded_color(message, who);
  const auto kind = color_kinds().find(message.encoding);
  if (kind != color_kinds().end()) return kind->second(message, who);
  return bad(who, "an encoding of rgb8, bgr8, rgba8, bgra8, mono8, 8UC1, 8UC3, 8UC4",
             "\"" + message.encoding + "\"");
}

Result<Depth> depth_image(const ImageMessage& message, const std::string& who) {
  if (message.compressed) return compressed_depth(message, who);
  const bool millimetres = message.encoding == "16UC1" || message.encoding == "mono16";
  if (!millimetres && message.encoding != "32FC1") {
    return bad(who, "an encoding of 16UC1 (mm), mono16 (mm) or 32FC1 (m)",
               "\"" + message.encoding + "\"");
  }
  if (!millimetres) {
    auto metres = raw_pixels<float>(message, who);
    if (metres && message.big_endian) swap_bytes(*metres);
    return metres;
  }
  auto pixels = raw_pixels<std::uint16_t>(message, who);
  if (!pixels) return pixels.error();
  if (message.big_endian) swap_bytes(*pixels);
  return metres_of({pixels->data(), pixels->total()}, pixels->size());
}

Result<image::Mask> mask_image(const ImageMessage& message, const std::string& who) {
  const bool known = message.encoding == "mono8" || message.encoding == "8UC1";
  if (!message.compressed && !known) {
    return bad(who, "a mask of encoding mono8 or 8UC1", "\"" + message.encoding + "\"");
  }
  auto mask =
      message.compressed ? decoded_grey(message, who) : raw_pixels<std::uint8_t>(message, who);
  if (!mask) return mask;
  if (*std::max_element(mask->data(), mask->data() + mask->total()) == 1) {
    return bad(who, "the rope over 127", "values of 0 and 1; multiply by 255");
  }
  return mask;
}

}  // namespace flowdlo::recording
