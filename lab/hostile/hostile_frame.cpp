#include "hostile/hostile_frame.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace flowdlo::lab {
namespace {

constexpr float kNearest_m = 0.5F;
constexpr float kTilt_m = 0.1F;  // from the left border to the right one
constexpr float kAbove_m = 0.03F;
constexpr float kNoise_m = 0.001F;
constexpr std::uint32_t kMissing = 8;  // of 256 depths

/// 0 to 255, another one for each pixel.
std::uint32_t scrambled(std::uint32_t pixel) {
  pixel *= 2654435761U;
  pixel ^= pixel >> 15;
  pixel *= 2246822519U;
  return pixel >> 24;
}

}  // namespace

FrameFolder frame_around(const cv::Mat& mask, std::string name) {
  FrameFolder frame;
  frame.name = std::move(name);
  frame.width = mask.cols;
  frame.height = mask.rows;
  const auto width = static_cast<float>(mask.cols);
  frame.intrinsics = {0.95F * width, 0.95F * width, 0.5F * (width - 1),
                      0.5F * (static_cast<float>(mask.rows) - 1)};
  frame.depth_m.resize(mask.total());
  frame.mask.resize(mask.total());
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(mask.cols) +
                         static_cast<std::size_t>(u);
      const std::uint32_t dice = scrambled(static_cast<std::uint32_t>(pixel));
      frame.mask[pixel] = mask.at<std::uint8_t>(v, u);
      const float above = frame.mask[pixel] > 127 ? kAbove_m : 0;
      const float noise = kNoise_m * (static_cast<float>(dice) / 127.5F - 1);
      const float depth = kNearest_m + kTilt_m * static_cast<float>(u) / width - above + noise;
      frame.depth_m[pixel] = dice < kMissing ? 0 : depth;
    }
  }
  return frame;
}

}  // namespace flowdlo::lab
