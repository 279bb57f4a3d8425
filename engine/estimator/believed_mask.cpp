#include "estimator/believed_mask.hpp"

#include <cmath>
#include <cstddef>
#include <span>

#include "field/block_map.hpp"
#include "geometry/mask_box.hpp"
#include "image/brush.hpp"
#include "image/masks.hpp"

namespace flowdlo::estimator {
namespace {

constexpr std::size_t kLeastRope = 30;  // pixels that a field has to show to be believed
constexpr int kStep_px = 3;             // of a first look at every ninth pixel,
constexpr float kPlainly = 0.86F;       // which is enough where so many agree,
constexpr std::size_t kEnough = 100;    // of so many

/// How many pixels a mask and what is taken for rope have.
struct Counts {
  std::size_t masked = 0;
  std::size_t both = 0;
  std::size_t beside = 0;  // rope that is not masked

  void add(bool in_mask, bool rope) {
    masked += in_mask ? 1 : 0;
    both += in_mask && rope ? 1 : 0;
    beside += !in_mask && rope ? 1 : 0;
  }
  [[nodiscard]] bool agrees(float share = kAgreeing) const {
    return shared(masked + beside, share);
  }
  [[nodiscard]] bool too_wide() const { return !shared(masked, kAgreeing); }

 private:
  [[nodiscard]] bool shared(std::size_t of, float share) const {
    return static_cast<float>(both) >= share * static_cast<float>(of);
  }
};

Counts counted(const std::vector<std::uint8_t>& rope, std::span<const std::uint8_t> mask) {
  Counts counts;
  for (std::size_t p = 0; p < rope.size(); ++p) counts.add(mask[p] > 127, rope[p] != 0);
  return counts;
}

/// Whether mask and field agree by a first look, a tenth of the time of counting all.
bool plainly_agrees(const Frame& frame, const field::FieldView& seen) {
  const image::Rect mask = geometry::mask_box(frame);
  const int margin_px = field::kNear_px;
  const image::Rect box = image::Rect{mask.x - margin_px, mask.y - margin_px,
                                      mask.width + 2 * margin_px, mask.height + 2 * margin_px} &
                          image::Rect{0, 0, frame.width, frame.height};
  Counts counts;
  for (int v = box.y; v < box.y + box.height; v += kStep_px) {
    const auto* const row = frame.mask.data() + static_cast<std::size_t>(v) * frame.width;
    for (int u = box.x; u < box.x + box.width; u += kStep_px) {
      counts.add(row[u] > 127, seen.is_rope({static_cast<float>(u), static_cast<float>(v)}));
    }
  }
  return counts.both >= kEnough && counts.agrees(kPlainly);
}

/// Leaves of `rope` what lies within so many pixels of the mask.
void keep_near(const Frame& frame, int reach_px, std::vector<std::uint8_t>& rope) {
  const image::Image<const std::uint8_t> given(frame.mask.data(), {frame.width, frame.height},
                                               frame.width);
  const image::Mask near = image::dilated(image::above(given, 127, 255), reach_px);
  for (int v = 0; v < frame.height; ++v) {
    auto* const row = rope.data() + static_cast<std::size_t>(v) * frame.width;
    for (int u = 0; u < frame.width; ++u) row[u] &= near.at(v, u);
  }
}

}  // namespace

std::vector<std::uint8_t> believed_mask(const Frame& frame, float rope_width_px,
                                        const field::Axes& seen) {
  if (plainly_agrees(frame, seen.view)) return {};
  std::vector<std::uint8_t> rope = seen.view.rope_mask(frame.width, frame.height);
  Counts counts = counted(rope, frame.mask);
  if (counts.both < kLeastRope || counts.agrees()) return {};
  const bool narrow = rope_width_px < kAgreeing * seen.width_px;
  const bool adds = !counts.too_wide() && narrow && frame.instances.empty();
  keep_near(frame, adds ? static_cast<int>(std::lround(0.5F * seen.width_px)) : 0, rope);
  counts = counted(rope, frame.mask);
  return counts.agrees() ? std::vector<std::uint8_t>() : rope;
}

}  // namespace flowdlo::estimator
