#include "drawn_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flowdlo::fuzz {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<float, 16> kOddDepths = {0.0F,
                                              -0.0F,
                                              -1.0F,
                                              std::numeric_limits<float>::quiet_NaN(),
                                              kInfinity,
                                              -kInfinity,
                                              std::numeric_limits<float>::denorm_min(),
                                              std::numeric_limits<float>::min(),
                                              std::numeric_limits<float>::max(),
                                              1.0e-7F,
                                              1.0e-6F,
                                              0.01F,
                                              65.535F,
                                              1.0e4F,
                                              1.0e10F,
                                              1.0e30F};

/// Metres: what no camera measures, then 0.2 to 2.1.
float depth_of(int byte) {
  const auto index = static_cast<std::size_t>(byte);
  return index < kOddDepths.size() ? kOddDepths[index] : 0.2F + static_cast<float>(byte) / 128.0F;
}

Intrinsics camera_of(ByteSource& bytes, int width, int height) {
  const int kind = bytes.byte();
  if (kind >= 240) {  // anything
    const auto fx = bytes.number<float>();
    const auto fy = bytes.number<float>();
    const auto cx = bytes.number<float>();
    const auto cy = bytes.number<float>();
    return {fx, fy, cx, cy};
  }
  const float focal_px = static_cast<float>(width) * (0.2F + static_cast<float>(kind) / 64.0F);
  return {focal_px, focal_px, 0.5F * static_cast<float>(width - 1),
          0.5F * static_cast<float>(height - 1)};
}

struct Stroke {
  int kind = 0;  // bits 0-1: 0 and 1 rope, 2 depth alone, 3 rubber; bits 2-5: thickness
  float from_u = 0;
  float from_v = 0;
  float to_u = 0;
  float to_v = 0;
  float depth_m = 0;

  [[nodiscard]] float radius_px() const { return 0.5F + 0.5F * static_cast<float>(kind / 4 % 16); }

  [[nodiscard]] bool covers(float u, float v) const {
    const float du = to_u - from_u;
    const float dv = to_v - from_v;
    const float length2 = du * du + dv * dv;
    const float along =
        length2 > 0 ? std::clamp(((u - from_u) * du + (v - from_v) * dv) / length2, 0.0F, 1.0F) : 0;
    return std::hypot(u - from_u - along * du, v - from_v - along * dv) <= radius_px();
  }
};

Stroke stroke_of(ByteSource& bytes, const DrawnFrame& frame) {
  const auto within = [&](int side_px) { return static_cast<float>(bytes.byte() % side_px); };
  Stroke stroke;
  stroke.kind = bytes.byte();
  stroke.from_u = within(frame.width);
  stroke.from_v = within(frame.height);
  stroke.to_u = within(frame.width);
  stroke.to_v = within(frame.height);
  stroke.depth_m = depth_of(bytes.byte());
  return stroke;
}

void draw(const Stroke& stroke, DrawnFrame& frame) {
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      if (!stroke.covers(static_cast<float>(u), static_cast<float>(v))) continue;
      const auto pixel = static_cast<std::size_t>(v * frame.width + u);
      if (stroke.kind % 4 != 2) frame.mask[pixel] = stroke.kind % 4 == 3 ? 0 : 255;
      if (stroke.kind % 4 != 3) frame.depth_m[pixel] = stroke.depth_m;
    }
  }
}

void flip_pixels(ByteSource& bytes, DrawnFrame& frame) {
  for (std::size_t pixel = 0; pixel < frame.mask.size() && !bytes.empty(); pixel += 8) {
    const int flips = bytes.byte();
    for (std::size_t bit = 0; bit < 8 && pixel + bit < frame.mask.size(); ++bit) {
      if ((flips >> bit & 1) != 0) frame.mask[pixel + bit] ^= 255;
    }
  }
}

}  // namespace

DrawnFrame draw_frame(ByteSource& bytes, int most_px) {
  DrawnFrame frame;
  frame.width = 1 + bytes.byte() % most_px;
  frame.height = 1 + bytes.byte() % most_px;
  frame.camera = camera_of(bytes, frame.width, frame.height);
  const auto pixels = static_cast<std::size_t>(frame.width * frame.height);
  frame.depth_m.assign(pixels, depth_of(bytes.byte()));
  frame.mask.assign(pixels, 0);
  const int strokes = bytes.byte() % 32;
  for (int i = 0; i < strokes && !bytes.empty(); ++i) draw(stroke_of(bytes, frame), frame);
  flip_pixels(bytes, frame);
  return frame;
}

}  // namespace flowdlo::fuzz
