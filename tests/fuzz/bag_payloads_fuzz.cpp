// The messages of a recording: an error, or pixels of the announced kind. The first byte says what
// the others are.
#include <cmath>

#include "frame/limits.hpp"
#include "png_file.hpp"
#include "promise.hpp"
#include "recording/bag_image.hpp"
#include "recording/bag_message.hpp"
#include "recording/rectification.hpp"
#include "target.hpp"

namespace {

using flowdlo::Result;
using flowdlo::fuzz::promise;
using namespace flowdlo::recording;

constexpr std::size_t kMostPixels = 1U << 16U;  // for larger ones a fuzzer has no time

/// Whether some part of `bytes` reads as the head of a JPEG's frame with more pixels than that.
bool holds_large_jpeg(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at + 8 < bytes.size(); ++at) {
    if (bytes[at] != 0xFF || (bytes[at + 1] & 0xF0) != 0xC0) continue;
    const std::size_t height = std::size_t{bytes[at + 5]} << 8 | bytes[at + 6];
    const std::size_t width = std::size_t{bytes[at + 7]} << 8 | bytes[at + 8];
    if (width * height > kMostPixels) return true;
  }
  return false;
}

bool is_large(const ImageMessage& message) {
  const std::span<const std::uint8_t> bytes(message.data);
  if (!message.compressed) {
    return message.width <= flowdlo::frame::kMaxSide_px &&
           std::size_t{message.width} * message.height > kMostPixels;
  }
  constexpr std::size_t kDepthHeaderBytes = 12;
  return flowdlo::fuzz::is_large_png(bytes) || holds_large_jpeg(message.data) ||
         flowdlo::fuzz::is_large_png(bytes.subspan(std::min(bytes.size(), kDepthHeaderBytes)));
}

void check_image(const Result<ImageMessage>& message) {
  if (!message || is_large(*message)) return;
  const auto check = [](const auto& image) {
    promise(!image || !image->empty(), "an image has pixels");
    promise(image || !image.error().message.empty(), "an error has words");
  };
  check(color_image(*message, "c"));
  check(depth_image(*message, "d"));
  check(mask_image(*message, "m"));
}

void check_camera(const Result<CameraMessage>& camera) {
  if (!camera) return;
  const bool large = camera->width <= flowdlo::frame::kMaxSide_px &&
                     std::size_t{camera->width} * camera->height > kMostPixels;
  if (large) return;
  for (const bool rectified : {false, true}) {
    const auto lens = Rectification::create(*camera, rectified, "i");
    if (!lens) continue;
    const flowdlo::image::Image<float> depth(lens->size(), 1.0F);
    promise(lens->nearest(depth).size() == lens->size(), "an image keeps its size");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::vector<std::uint8_t> bytes(data + 1, data + size);
  switch (data[0] % 3) {
    case 0:
      check_image(parse_image(bytes, "message"));
      break;
    case 1:
      check_image(parse_compressed_image(bytes, "message"));
      break;
    default:
      check_camera(parse_camera_info(bytes, "message"));
  }
  return 0;
}
