#include "recording/bag_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <opencv2/imgproc.hpp>
#include <span>

#include "frame/limits.hpp"
#include "mat/mat_png.hpp"
#include "recording/jpeg.hpp"

namespace flowdlo::recording {
namespace {

constexpr double kMetresAMillimetre = 0.001;
constexpr int kAsItIs = -1;                    // no conversion of colours
constexpr std::size_t kDepthHeaderBytes = 12;  // compressedDepth: format, quantisation a and b

struct RawKind {
  int type = 0;        ///< OpenCV's
  int conversion = 0;  ///< to BGR
};

const std::map<std::string, RawKind>& color_kinds() {
  static const std::map<std::string, RawKind> kinds{{"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
                                                    {"bgr8", {CV_8UC3, kAsItIs}},
                                                    {"8UC3", {CV_8UC3, kAsItIs}},
                                                    {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGR}},
                                                    {"bgra8", {CV_8UC4, cv::COLOR_BGRA2BGR}},
                                                    {"8UC4", {CV_8UC4, cv::COLOR_BGRA2BGR}},
                                                    {"mono8", {CV_8UC1, cv::COLOR_GRAY2BGR}},
                                                    {"8UC1", {CV_8UC1, cv::COLOR_GRAY2BGR}}};
  return kinds;
}

Error bad(const std::string& who, const std::string& expected, const std::string& got) {
  return {ErrorCode::kBadInput, fmt::format("{}: expected {}, got {}", who, expected, got)};
}

// A copy without padding.
Result<cv::Mat> raw_pixels(const ImageMessage& message, int type, const std::string& who) {
  const std::size_t row_bytes = static_cast<std::size_t>(CV_ELEM_SIZE(type)) * message.width;
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
  cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width), type);
  for (int v = 0; v < pixels.rows; ++v) {
    std::memcpy(pixels.ptr(v), message.data.data() + static_cast<std::size_t>(v) * step, row_bytes);
  }
  return pixels;
}

void swap_bytes(cv::Mat& pixels) {
  const std::size_t size = pixels.elemSize1();
  for (std::uint8_t* byte = pixels.data; byte < pixels.dataend; byte += size) {
    std::reverse(byte, byte + size);
  }
}

enum class Wanted { kAsStored, kBgr, kGrey };

/// 8 bits of one or three channels, as the rest of the reader wants them.
cv::Mat converted(const cv::Mat& picture, Wanted wanted) {
  if (wanted == Wanted::kAsStored) return picture;
  cv::Mat bytes;
  picture.convertTo(bytes, CV_8U, picture.depth() == CV_16U ? 1.0 / 256 : 1.0);
  const int channels = wanted == Wanted::kGrey ? 1 : 3;
  if (bytes.channels() == channels) return bytes;
  if (wanted == Wanted::kGrey) {
    cv::cvtColor(bytes, bytes, bytes.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  } else {
    cv::cvtColor(bytes, bytes, bytes.channels() == 4 ? cv::COLOR_BGRA2BGR : cv::COLOR_GRAY2BGR);
  }
  return bytes;
}

Result<cv::Mat> decoded(std::span<const std::uint8_t> bytes, Wanted wanted,
                        const std::string& format, const std::string& who) {
  if (const auto png = mat::decode_png(bytes, who)) return converted(*png, wanted);
  const JpegColors colors = wanted == Wanted::kGrey ? JpegColors::kGrey : JpegColors::kBgr;
  cv::Mat picture = decode_jpeg(bytes, colors, frame::kMaxSide_px);
  if (!picture.empty()) return picture;
  return bad(who, fmt::format("a JPEG or PNG of at most {} px a side", frame::kMaxSide_px),
             fmt::format("{} bytes of format \"{}\" that are none", bytes.size(), format));
}

// Rounded once, as for the depth.png of a frame folder: the same frame gives the same bits.
cv::Mat metres_of(const cv::Mat& millimetres) {
  cv::Mat depth_m(millimetres.size(), CV_32FC1);
  for (int v = 0; v < millimetres.rows; ++v) {
    for (int u = 0; u < millimetres.cols; ++u) {
      depth_m.at<float>(v, u) =
          static_cast<float>(millimetres.at<std::uint16_t>(v, u) * kMetresAMillimetre);
    }
  }
  return depth_m;
}

// depth = a / (value - b), 0 stays none: how compressedDepth packs floats into 16 bits.
cv::Mat unpacked(const cv::Mat& values, std::span<const std::uint8_t> header) {
  float a = 0;
  float b = 0;
  std::memcpy(&a, header.data() + sizeof(std::int32_t), sizeof(a));
  std::memcpy(&b, header.data() + sizeof(std::int32_t) + sizeof(a), sizeof(b));
  cv::Mat depth_m(values.size(), CV_32FC1);
  for (int v = 0; v < values.rows; ++v) {
    for (int u = 0; u < values.cols; ++u) {
      const int value = values.at<std::uint16_t>(v, u);
      depth_m.at<float>(v, u) = value == 0 ? 0.0F : a / (static_cast<float>(value) - b);
    }
  }
  return depth_m;
}

Result<cv::Mat> compressed_depth(const ImageMessage& message, const std::string& who) {
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
  const auto picture = decoded(bytes, Wanted::kAsStored, message.format, who);
  if (!picture) return picture.error();
  if (picture->type() != CV_16UC1) {
    return bad(who, "depth as a 16-bit PNG of 1 channel",
               fmt::format("{}-bit, {} channels", 8 * picture->elemSize1(), picture->channels()));
  }
  return packed && encoding == "32FC1" ? unpacked(*picture, header) : metres_of(*picture);
}

}  // namespace

Result<cv::Mat> color_image(const ImageMessage& message, const std::string& who) {
  if (message.compressed) return decoded(message.data, Wanted::kBgr, message.format, who);
  const auto kind = color_kinds().find(message.encoding);
  if (kind == color_kinds().end()) {
    return bad(who, "an encoding of rgb8, bgr8, rgba8, bgra8, mono8, 8UC1, 8UC3, 8UC4",
               "\"" + message.encoding + "\"");
  }
  const auto pixels = raw_pixels(message, kind->second.type, who);
  if (!pixels || kind->second.conversion == kAsItIs) return pixels;
  cv::Mat bgr;
  cv::cvtColor(*pixels, bgr, kind->second.conversion);
  return bgr;
}

Result<cv::Mat> depth_image(const ImageMessage& message, const std::string& who) {
  if (message.compressed) return compressed_depth(message, who);
  const bool millimetres = message.encoding == "16UC1" || message.encoding == "mono16";
  if (!millimetres && message.encoding != "32FC1") {
    return bad(who, "an encoding of 16UC1 (mm), mono16 (mm) or 32FC1 (m)",
               "\"" + message.encoding + "\"");
  }
  auto pixels = raw_pixels(message, millimetres ? CV_16UC1 : CV_32FC1, who);
  if (!pixels) return pixels;
  if (message.big_endian) swap_bytes(*pixels);
  return millimetres ? metres_of(*pixels) : *pixels;
}

Result<cv::Mat> mask_image(const ImageMessage& message, const std::string& who) {
  const bool known = message.encoding == "mono8" || message.encoding == "8UC1";
  if (!message.compressed && !known) {
    return bad(who, "a mask of encoding mono8 or 8UC1", "\"" + message.encoding + "\"");
  }
  const auto mask = message.compressed ? decoded(message.data, Wanted::kGrey, message.format, who)
                                       : raw_pixels(message, CV_8UC1, who);
  if (!mask) return mask;
  double largest = 0;
  cv::minMaxLoc(*mask, nullptr, &largest);
  if (largest == 1) return bad(who, "the rope over 127", "values of 0 and 1; multiply by 255");
  return mask;
}

cv::Mat hsv_mask(const cv::Mat& color_bgr, const HsvRange& range) {
  const auto scalar = [](int h, const std::array<int, 3>& bound) {
    return cv::Scalar(h, bound[1], bound[2]);
  };
  cv::Mat hsv;
  cv::cvtColor(color_bgr, hsv, cv::COLOR_BGR2HSV);
  cv::Mat mask;
  if (range.low[0] <= range.high[0]) {
    cv::inRange(hsv, scalar(range.low[0], range.low), scalar(range.high[0], range.high), mask);
    return mask;
  }
  constexpr int kMostHue = 179;
  cv::Mat below;
  cv::inRange(hsv, scalar(range.low[0], range.low), scalar(kMostHue, range.high), mask);
  cv::inRange(hsv, scalar(0, range.low), scalar(range.high[0], range.high), below);
  return mask | below;
}

}  // namespace flowdlo::recording
