// Spec section 6: the half-resolution mask and what is derived from it.
//
// Outside the image there is no mask: the Gaussian reads zero there, as the displacement knows only
// pixels inside.
#include "evidence/mask_field.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "evidence/nearest_pixel.hpp"

namespace flowdlo::evidence {
namespace {

constexpr double kSmoothingSigma_px = 2.5;    // half-resolution px, spec section 6
constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask

/// [height / 2, width / 2] share of mask pixels under each field pixel, 0..1.
cv::Mat1f area_average(const Frame& frame, int width, int height) {
  cv::Mat1f mask(frame.height, frame.width);
  std::transform(frame.mask.begin(), frame.mask.end(), mask[0],
                 [](std::uint8_t value) { return value > kMaskThreshold ? 1.0F : 0.0F; });
  cv::Mat1f average;
  cv::resize(mask, average, {width, height}, 0, 0, cv::INTER_AREA);
  cv::min(average, 1.0, average);  // the weights of a pixel may sum to a little more than 1
  return average;
}

cv::Mat1f smoothed(const cv::Mat1f& mask) {
  cv::Mat1f result;
  cv::GaussianBlur(mask, result, {}, kSmoothingSigma_px, kSmoothingSigma_px, cv::BORDER_CONSTANT);
  return result;
}

/// Channels 2 and 3. Without any mask pixel the displacement is one field width along u and v:
/// 640 px of a 640-px-wide image, beyond what the local features tell apart (300 px).
void fill_displacement(const std::vector<std::int32_t>& nearest, MaskField& field) {
  const auto far_px = static_cast<float>(field.width);
  for (int v = 0; v < field.height; ++v) {
    for (int u = 0; u < field.width; ++u) {
      const auto index = static_cast<std::size_t>(v * field.width + u);
      const bool none = nearest.empty();
      field.texels[4 * index + 2] =
          none ? far_px : static_cast<float>(nearest[index] % field.width - u);
      field.texels[4 * index + 3] =
          none ? far_px : static_cast<float>(nearest[index] / field.width - v);
    }
  }
}

}  // namespace

MaskField mask_field(const Frame& frame) {
  MaskField field;
  field.width = std::max(1, frame.width / 2);
  field.height = std::max(1, frame.height / 2);
  const cv::Mat1f mask = area_average(frame, field.width, field.height);
  const cv::Mat1f smooth = smoothed(mask);

  const auto count = static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height);
  std::vector<std::uint8_t> set(count);
  field.texels.resize(4 * count);
  const float* const share = mask[0];
  const float* const soft = smooth[0];
  for (std::size_t i = 0; i < count; ++i) {
    set[i] = share[i] > 0 ? 1 : 0;
    field.texels[4 * i] = share[i];
    field.texels[4 * i + 1] = soft[i];
  }
  fill_displacement(nearest_set_pixel(set, field.width, field.height), field);
  return field;
}

}  // namespace flowdlo::evidence
