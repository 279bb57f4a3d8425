// Spec section 6: the half-resolution mask and what is derived from it.
//
// Outside the image there is no mask: the Gaussian reads zero there, as the displacement knows only
// pixels inside.
#include "evidence/mask_field.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "evidence/nearest_pixel.hpp"
#include "image/blur.hpp"
#include "image/resize.hpp"

namespace flowdlo::evidence {
namespace {

constexpr double kSmoothingSigma_px = 2.5;    // half-resolution px, spec section 6
constexpr int kSmoothingReach = 10;           // half-resolution px, four sigmas: 21 taps
constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask

bool masked(std::uint8_t value) { return value > kMaskThreshold; }

/// The mean of each two by two pixels: what area_average gives where sides are even.
image::Image<float> mean_of_fours(const Frame& frame, int width, int height) {
  image::Image<float> mean({width, height});
  for (int v = 0; v < height; ++v) {
    const std::uint8_t* const upper =
        frame.mask.data() + std::size_t{2} * static_cast<std::size_t>(v * frame.width);
    const std::uint8_t* const lower = upper + frame.width;
    float* const row = mean.row(v);
    for (int u = 0; u < width; ++u) {
      const int count = masked(upper[2 * u]) + masked(upper[2 * u + 1]) + masked(lower[2 * u]) +
                        masked(lower[2 * u + 1]);
      row[u] = 0.25F * static_cast<float>(count);
    }
  }
  return mean;
}

/// [height / 2, width / 2] share of mask pixels under each field pixel, 0..1.
image::Image<float> area_average(const Frame& frame, int width, int height) {
  if (frame.width == 2 * width && frame.height == 2 * height) {
    return mean_of_fours(frame, width, height);
  }
  image::Image<float> mask({frame.width, frame.height});
  std::transform(frame.mask.begin(), frame.mask.end(), mask.data(),
                 [](std::uint8_t value) { return masked(value) ? 1.0F : 0.0F; });
  auto average = image::area_mean<float>(mask, {width, height});
  float* const shares = average.data();  // the weights of a pixel may sum to a little more than 1
  std::transform(shares, shares + average.total(), shares,
                 [](float share) { return std::min(share, 1.0F); });
  return average;
}

/// The rows in which the mask has a share, and as many beside them as the Gaussian spreads it to.
image::Rect smoothed_rows(const image::Image<float>& mask) {
  const auto empty = [&](int v) {
    return std::all_of(mask.row(v), mask.row(v) + mask.width(),
                       [](float share) { return share == 0; });
  };
  int first = 0;
  while (first < mask.height() && empty(first)) ++first;
  int end = mask.height();
  while (end > first && empty(end - 1)) --end;
  if (first == end) return {};
  const int from = std::max(0, first - kSmoothingReach);
  const int to = std::min(mask.height(), end + kSmoothingReach);
  return {0, from, mask.width(), to - from};
}

image::Image<float> smoothed(const image::Image<float>& mask) {
  image::Image<float> result(mask.size(), 0.0F);
  const image::Rect rows = smoothed_rows(mask);
  if (rows.empty()) return result;
  const auto taps = image::gaussian(2 * kSmoothingReach + 1, kSmoothingSigma_px);
  const auto part = image::blurred(mask.part(rows), taps, image::Beyond::kZero);
  std::copy_n(part.data(), part.total(), result.row(rows.y));
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
  const image::Image<float> mask = area_average(frame, field.width, field.height);
  const image::Image<float> smooth = smoothed(mask);

  const auto count = static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height);
  std::vector<std::uint8_t> set(count);
  std::transform(mask.data(), mask.data() + count, set.begin(),
                 [](float share) { return static_cast<std::uint8_t>(share > 0); });
  NearestPixels nearest(set, field.width, field.height);
  field.texels.resize(4 * count);
  if (nearest.of_row(0).empty()) {
    fill_empty(field);
    return field;
  }
  for (int v = 0; v < field.height; ++v) {
    const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(field.width);
    fill_row(mask.row(v), smooth.row(v), nearest.of_row(v), v, field.texels.data() + 4 * row);
  }
  return field;
}

}  // namespace flowdlo::evidence
