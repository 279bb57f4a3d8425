#include "synth/mask_segmenter.hpp"

#include <algorithm>
#include <cmath>

#include "synth/pixel_noise.hpp"

namespace flowdlo::synth {
namespace {

struct Canvas {
  int width;
  int height;
  std::vector<std::uint8_t>& mask;

  void paint(int u, int v, std::uint8_t value) {
    if (u < 0 || v < 0 || u >= width || v >= height) return;
    mask[static_cast<std::size_t>(v) * width + u] = value;
  }
  void disc(int u, int v, int reach, std::uint8_t value) {
    for (int dv = -reach; dv <= reach; ++dv) {
      for (int du = -reach; du <= reach; ++du) {
        if (du * du + dv * dv <= reach * reach) paint(u + du, v + dv, value);
      }
    }
  }
};

// The rope's pixels that touch something else.
std::vector<std::uint32_t> border_of(const Picture& ideal, int width, int height) {
  std::vector<std::uint32_t> border;
  for (const Surface& seen : ideal.surfaces) {
    if (seen.thing != kRopeThing) continue;
    const int u = static_cast<int>(seen.pixel) % width;
    const int v = static_cast<int>(seen.pixel) / width;
    if (u < 1 || v < 1 || u + 1 >= width || v + 1 >= height) continue;
    const std::uint8_t* at = ideal.mask.data() + seen.pixel;
    if (at[-1] == 0 || at[1] == 0 || *(at - width) == 0 || at[width] == 0) {
      border.push_back(seen.pixel);
    }
  }
  return border;
}

// Grows here and shrinks there, as a smooth field says; more growth than shrinkage, as masks bleed.
void fray(const std::vector<std::uint32_t>& border, int reach, bool inwards,
          const PixelNoise& noise, Canvas& canvas) {
  const float cell = 5.0F * static_cast<float>(canvas.width) / 640.0F;
  for (const std::uint32_t pixel : border) {
    const int u = static_cast<int>(pixel) % canvas.width;
    const int v = static_cast<int>(pixel) / canvas.width;
    const float field = noise.smooth(static_cast<float>(u), static_cast<float>(v), cell);
    const int grow =
        static_cast<int>(std::lround(2.4F * (field - 0.42F) * (0.5F + static_cast<float>(reach))));
    if (grow > 0) canvas.disc(u, v, grow, 255);
    if (grow < 0 && inwards) canvas.disc(u, v, std::min(-grow - 1, reach), 0);
  }
}

// Takes away what lies beside a rope that is nearer: the lower one's mask ends before the upper
// one.
void part(const Picture& ideal, int reach, Canvas& canvas) {
  const auto labels = labels_of(ideal);
  for (const Surface& seen : ideal.surfaces) {
    if (seen.thing != kRopeThing) continue;
    const int u = static_cast<int>(seen.pixel) % canvas.width;
    const int v = static_cast<int>(seen.pixel) / canvas.width;
    bool below = false;
    for (int y = std::max(0, v - reach); y <= std::min(canvas.height - 1, v + reach); ++y) {
      for (int x = std::max(0, u - reach); x <= std::min(canvas.width - 1, u + reach); ++x) {
        const auto other = static_cast<std::size_t>(y) * canvas.width + x;
        below = below || (labels[other] > 0 && labels[other] != seen.rope + 1 &&
                          ideal.depth_m[other] < seen.z_m);
      }
    }
    if (below) canvas.paint(u, v, 0);
  }
}

void scatter_specks(const View& view, int count, int scale, const PixelNoise& noise,
                    Canvas& canvas) {
  for (int k = 0; k < count; ++k) {
    const auto salt = static_cast<std::uint32_t>(k);
    const auto& points = view.curves[salt % view.curves.size()].points;
    float u = noise.uniform(salt, 21) * static_cast<float>(canvas.width);
    float v = noise.uniform(salt, 22) * static_cast<float>(canvas.height);
    if (noise.uniform(salt, 23) < 0.5F) {  // near the rope
      const auto at =
          static_cast<std::size_t>(noise.uniform(salt, 24) * static_cast<float>(points.size() - 1));
      const Vector2d near = view.project(points[at]);
      u = static_cast<float>(near.x()) + 60.0F * (noise.uniform(salt, 25) - 0.5F);
      v = static_cast<float>(near.y()) + 60.0F * (noise.uniform(salt, 26) - 0.5F);
    }
    const int reach = static_cast<int>(4 * noise.uniform(salt, 27)) * scale;
    canvas.disc(static_cast<int>(u), static_cast<int>(v), reach, 255);
  }
}

}  // namespace

std::vector<std::uint16_t> labels_of(const Picture& ideal) {
  std::vector<std::uint16_t> labels(ideal.mask.size(), 0);
  for (const Surface& seen : ideal.surfaces) {
    if (seen.thing != kRopeThing) continue;
    labels[seen.pixel] = static_cast<std::uint16_t>(seen.rope + 1);
  }
  return labels;
}

std::vector<std::uint8_t> segmented_mask(const View& view, const Picture& ideal,
                                         const MaskFaults& faults, std::uint32_t seed) {
  std::vector<std::uint8_t> mask = ideal.mask;
  const int width = view.sensor->width;
  Canvas canvas{width, view.sensor->height, mask};
  const PixelNoise noise(seed);
  const int scale = width > 960 ? 2 : 1;
  if (faults.ragged_px > 0 || faults.shift_px != 0) {
    const auto border = border_of(ideal, width, canvas.height);
    if (faults.ragged_px > 0)
      fray(border, scale * faults.ragged_px, faults.frayed_inwards, noise, canvas);
    for (const std::uint32_t pixel : border) {
      const int u = static_cast<int>(pixel) % width;
      const int v = static_cast<int>(pixel) / width;
      if (faults.shift_px > 0) canvas.disc(u, v, 1, 255);
      if (faults.shift_px < 0) canvas.paint(u, v, 0);
    }
  }
  for (const Stretch& gap : faults.gaps) {
    for (const Surface& seen : ideal.surfaces) {
      if (seen.thing == kRopeThing && gap.holds(seen.rope, seen.along)) mask[seen.pixel] = 0;
    }
  }
  if (faults.parted_px > 0) part(ideal, scale * faults.parted_px, canvas);
  if (faults.specks > 0) scatter_specks(view, faults.specks, scale, noise, canvas);
  return mask;
}

}  // namespace flowdlo::synth
