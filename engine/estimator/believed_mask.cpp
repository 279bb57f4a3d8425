#include "estimator/believed_mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "field/block_map.hpp"
#include "geometry/mask_box.hpp"
#include "image/brush.hpp"

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

  [[nodiscard]] bool agrees() const { return shared(masked + beside); }
  [[nodiscard]] bool too_wide() const { return !shared(masked); }

 private:
  [[nodiscard]] bool shared(std::size_t of) const {
    return static_cast<float>(both) >= kAgreeing * static_cast<float>(of);
  }
};

Counts counted(const std::vector<std::uint8_t>& rope, const std::span<const std::uint8_t>& mask) {
  Counts counts;
  for (std::size_t p = 0; p < rope.size(); ++p) {
    const bool in_mask = mask[p] > 127;
    counts.masked += in_mask ? 1 : 0;
    counts.both += in_mask && rope[p] != 0 ? 1 : 0;
    counts.beside += !in_mask && rope[p] != 0 ? 1 : 0;
  }
  return counts;
}

/// Whether mask and field agree by a first look, a tenth of the time of counting all.
bool plainly_agrees(const Frame& frame, const field::FieldView& seen) {
  const image::Rect box = geometry::mask_box(frame);
  const int margin_px = field::kNear_px;
  std::size_t either = 0;
  std::size_t both = 0;
  for (int v = std::max(0, box.y - margin_px);
       v < std::min(frame.height, box.y + box.height + margin_px); v += kStep_px) {
    const auto* const row = frame.mask.data() + static_cast<std::size_t>(v) * frame.width;
    for (int u = std::max(0, box.x - margin_px);
         u < std::min(frame.width, box.x + box.width + margin_px); u += kStep_px) {
      const Eigen::Vector2f p(static_cast<float>(u), static_cast<float>(v));
      const bool rope = seen.at(p, field::kRope) > 0.5F;
      const bool masked = row[u] > 127;
      either += rope || masked ? 1 : 0;
      both += rope && masked ? 1 : 0;
    }
  }
  return both >= kEnough && static_cast<float>(both) >= kPlainly * static_cast<float>(either);
}

/// Leaves of `rope` what lies within so many pixels of the mask.
void keep_near(const Frame& frame, int reach_px, std::vector<std::uint8_t>& rope) {
  image::Mask mask({frame.width, frame.height});
  for (int v = 0; v < frame.height; ++v) {
    const auto* const row = frame.mask.data() + static_cast<std::size_t>(v) * frame.width;
    std::transform(row, row + frame.width, mask.row(v),
                   [](std::uint8_t at) { return at > 127 ? std::uint8_t{255} : std::uint8_t{0}; });
  }
  const image::Mask near = image::dilated(mask, reach_px);
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
