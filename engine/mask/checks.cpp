#include "mask/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "frame/limits.hpp"

namespace flowdlo::mask {
namespace {

constexpr float kMostArea_px2 = 1e6F;

bool is_side(int side_px) { return side_px >= 1 && side_px <= frame::kMaxSide_px; }

}  // namespace

void Checks::fault(const std::string& what) {
  faults_.bad_input(fmt::format("{}: {}", who_, what));
}

void Checks::size(int width, int height) {
  if (is_side(width) && is_side(height)) return;
  fault(fmt::format("expected an image of 1 to {} px a side, got {} x {}; scale it",
                    frame::kMaxSide_px, width, height));
}

void Checks::count(const char* name, std::size_t values, const Frame& frame, int channels,
                   const char* remedy) {
  if (!is_side(frame.width) || !is_side(frame.height)) return;  // said already
  const auto expected = static_cast<std::size_t>(frame.width) *
                        static_cast<std::size_t>(frame.height) * static_cast<std::size_t>(channels);
  if (values == expected) return;
  fault(fmt::format("Frame.{}: expected {} values ({} x {}{}), got {}; {}", name, expected,
                    frame.width, frame.height, channels == 3 ? " x 3" : "", values, remedy));
}

void Checks::color(const Frame& frame) {
  count("color_bgr", frame.color_bgr.size(), frame, 3,
        "a mask by colour needs the colour image, one without it mask_from_plane");
}

void Checks::depth(const Frame& frame) {
  count("depth_m", frame.depth_m.size(), frame, 1, "align depth to the colour image");
}

void Checks::intrinsics(const Intrinsics& intrinsics) {
  const auto usable = [](float focal_px, float center_px) {
    return focal_px >= frame::kMinFocal_px && focal_px <= frame::kMaxFocal_px &&
           std::abs(center_px) <= frame::kMaxFocal_px;
  };
  if (usable(intrinsics.fx, intrinsics.cx) && usable(intrinsics.fy, intrinsics.cy)) return;
  fault(
      fmt::format("Frame.intrinsics: expected focal lengths of {} to {} px and a principal point, "
                  "got fx {}, fy {}, cx {}, cy {}; give those of the camera matrix",
                  frame::kMinFocal_px, frame::kMaxFocal_px, intrinsics.fx, intrinsics.fy,
                  intrinsics.cx, intrinsics.cy));
}

void Checks::within(const char* name, float value, float least, float most) {
  if (value >= least && value <= most) return;
  fault(fmt::format("{}: expected {} to {}, got {}", name, least, most, value));
}

void Checks::positive(const char* name, float value, float most) {
  if (value > 0 && value <= most) return;
  fault(fmt::format("{}: expected more than 0 and at most {}, got {}", name, most, value));
}

void Checks::cleaning(const MaskCleaning& cleaning) {
  within("cleaning.fill_holes_px2", cleaning.fill_holes_px2, 0, kMostArea_px2);
  within("cleaning.least_piece_px2", cleaning.least_piece_px2, 0, kMostArea_px2);
}

Result<void> Checks::outcome() const {
  if (faults_.empty()) return {};
  return faults_.error();
}

}  // namespace flowdlo::mask
