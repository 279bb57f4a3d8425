// Spec section 6: the half-resolution mask and what is derived from it.
//
// Outside the image there is no mask: the Gaussian reads zero there, as the displacement knows only
// pixels inside.
#include "evidence/mask_field.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <vector>

#include "evidence/nearest_pixel.hpp"

namespace flowdlo::evidence {
namespace {

constexpr double kSmoothingSigma_px = 2.5;    // half-resolution px, spec section 6
constexpr int kSmoothingReach = 10;           // half-resolution px, four sigmas: 21 taps
constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask

bool masked(std::uint8_t value) { return value > kMaskThreshold; }

/// The mean of each two by two pixels: what area_average gives where sides are even.
cv::Mat1f mean_of_fours(const Frame& frame, int width, int height) {
  cv::Mat1f mean(height, width);
  for (int v = 0; v < height; ++v) {
    const std::uint8_t* const upper =
        frame.mask.data() + std::size_t{2} * static_cast<std::size_t>(v * frame.width);
    const std::uint8_t* const lower = upper + frame.width;
    float* const row = mean[v];
    for (int u = 0; u < width; ++u) {
      const int count = masked(upper[2 * u]) + masked(upper[2 * u + 1]) + masked(lower[2 * u]) +
                        masked(lower[2 * u + 1]);
      row[u] = 0.25F * static_cast<float>(count);
    }
  }
  return mean;
}

/// [height / 2, width / 2] share of mask pixels under each field pixel, 0..1.
cv::Mat1f area_average(const Frame& frame, int width, int height) {
  if (frame.width == 2 * width && frame.height == 2 * height) {
    return mean_of_fours(frame, width, height);
  }
  cv::Mat1f mask(frame.height, frame.width);
  std::transform(frame.mask.begin(), frame.mask.end(), mask[0],
                 [](std::uint8_t value) { return masked(value) ? 1.0F : 0.0F; });
  cv::Mat1f average;
  cv::resize(mask, average, {width, height}, 0, 0, cv::INTER_AREA);
  cv::min(average, 1.0, average);  // the weights of a pixel may sum to a little more than 1
  return average;
}

/// The rows in which the mask has a share, and as many beside them as the Gaussian spreads it to.
cv::Range smoothed_rows(const cv::Mat1f& mask) {
  const auto empty = [&](int v) {
    return std::all_of(mask[v], mask[v] + mask.cols, [](float share) { return share == 0; });
  };
  int first = 0;
  while (first < mask.rows && empty(first)) ++first;
  int end = mask.rows;
  while (end > first && empty(end - 1)) --end;
  if (first == end) return {0, 0};
  return {std::max(0, first - kSmoothingReach), std::min(mask.rows, end + kSmoothingReach)};
}

cv::Mat1f smoothed(const cv::Mat1f& mask) {
  cv::Mat1f result(mask.size(), 0.0F);
  const cv::Range rows = smoothed_rows(mask);
  if (rows.empty()) return result;
  constexpr int kTaps = 2 * kSmoothingReach + 1;
  cv::Mat1f part = result.rowRange(rows);
  cv::GaussianBlur(mask.rowRange(rows), part, {kTaps, kTaps}, kSmoothingSigma_px,
                   kSmoothingSigma_px, cv::BORDER_CONSTANT);
  return result;
}

/// Row v of the field.
void fill_row(const float* share, const float* smooth, std::span<const Pixel> nearest, int v,
              float* texel) {
  for (int u = 0; u < std::ssize(nearest); ++u, texel += 4) {
    const Pixel& pixel = nearest[static_cast<std::size_t>(u)];
    texel[0] = share[u];
    texel[1] = smooth[u];
    texel[2] = static_cast<float>(pixel.u - u);
    texel[3] = static_cast<float>(pixel.v - v);
  }
}

/// A field without any mask pixel. The displacement is one field width along u and v: 640 px of a
/// 640-px-wide image, beyond what the local features tell apart (300 px).
void fill_empty(MaskField& field) {
  const auto far_px = static_cast<float>(field.width);
  for (std::size_t i = 0; i < field.texels.size(); i += 4) {
    field.texels[i + 2] = field.texels[i + 3] = far_px;
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
  std::transform(mask.begin(), mask.end(), set.begin(),
                 [](float share) { return static_cast<std::uint8_t>(share > 0); });
  NearestPixels nearest(set, field.width, field.height);
  field.texels.resize(4 * count);
  if (nearest.of_row(0).empty()) {
    fill_empty(field);
    return field;
  }
  for (int v = 0; v < field.height; ++v) {
    const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(field.width);
    fill_row(mask[v], smooth[v], nearest.of_row(v), v, field.texels.data() + 4 * row);
  }
  return field;
}

}  // namespace flowdlo::evidence
