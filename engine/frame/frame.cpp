#include "flowdlo/frame.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "frame/faults.hpp"
#include "frame/limits.hpp"
#include "geometry/depth.hpp"
#include "geometry/mask_box.hpp"
#include "guard/guarded.hpp"

namespace flowdlo {
namespace {

using frame::Faults;

void check_size(const Frame& frame, Faults& faults) {
  const auto fits = [](int side_px) { return side_px >= 1 && side_px <= frame::kMaxSide_px; };
  if (!fits(frame.width)) {
    faults.bad_input(fmt::format("Frame.width: expected 1 to {} px, got {}; scale the images",
                                 frame::kMaxSide_px, frame.width));
  }
  if (!fits(frame.height)) {
    faults.bad_input(fmt::format("Frame.height: expected 1 to {} px, got {}; scale the images",
                                 frame::kMaxSide_px, frame.height));
  }
}

void check_focal_length(const char* name, float focal_px, Faults& faults) {
  const bool usable =
      std::isfinite(focal_px) && focal_px >= frame::kMinFocal_px && focal_px <= frame::kMaxFocal_px;
  if (usable) return;
  faults.bad_input(
      fmt::format("Frame.intrinsics.{}: expected {} to {} px, got {}; give the focal length of "
                  "the camera matrix",
                  name, frame::kMinFocal_px, frame::kMaxFocal_px, focal_px));
}

void check_center(const char* name, float center_px, Faults& faults) {
  if (std::isfinite(center_px) && std::abs(center_px) <= frame::kMaxFocal_px) return;
  faults.bad_input(fmt::format(
      "Frame.intrinsics.{}: expected -{} to {} px, got {}; give the principal point of the camera "
      "matrix",
      name, frame::kMaxFocal_px, frame::kMaxFocal_px, center_px));
}

void check_count(const char* name, std::size_t count, const Frame& frame, int channels,
                 Faults& faults) {
  if (frame.width < 1 || frame.height < 1) return;  // said already
  const auto expected = static_cast<std::size_t>(frame.width) *
                        static_cast<std::size_t>(frame.height) * static_cast<std::size_t>(channels);
  if (count == expected) return;
  const std::string shape = channels == 1
                                ? fmt::format("{} x {}", frame.width, frame.height)
                                : fmt::format("{} x {} x {}", frame.width, frame.height, channels);
  faults.bad_input(
      fmt::format("Frame.{}: expected {} values ({}), got {}", name, expected, shape, count));
}

/// Refused is what can only be another unit: the rope, where most of its depths are that far.
void check_unit(const Frame& frame, Faults& faults) {
  std::size_t measured = 0;
  std::size_t far = 0;
  double sum_m = 0;
  geometry::each_masked(frame, [&](int, int, std::size_t pixel) {
    const float depth_m = frame.depth_m[pixel];
    if (!(depth_m > geometry::kLeastDepth_m) || !std::isfinite(depth_m)) return;
    ++measured;
    if (depth_m <= frame::kMostRope_m) return;
    ++far;
    sum_m += static_cast<double>(depth_m);
  });
  if (2 * far <= measured) return;
  faults.bad_input(fmt::format(
      "Frame.depth_m: expected metres, below {} where the mask is set, got {:.4g} on average; "
      "multiply millimetres by 0.001, in camera.json set depth_scale to the metres of a unit",
      frame::kMostRope_m, sum_m / static_cast<double>(far)));
}

Result<void> checked(const Frame& frame) {
  Faults faults;
  check_size(frame, faults);
  check_focal_length("fx", frame.intrinsics.fx, faults);
  check_focal_length("fy", frame.intrinsics.fy, faults);
  check_center("cx", frame.intrinsics.cx, faults);
  check_center("cy", frame.intrinsics.cy, faults);
  check_count("depth_m", frame.depth_m.size(), frame, 1, faults);
  check_count("mask", frame.mask.size(), frame, 1, faults);
  if (!frame.color_bgr.empty()) {
    check_count("color_bgr", frame.color_bgr.size(), frame, 3, faults);
  }
  if (!frame.instances.empty()) {
    check_count("instances", frame.instances.size(), frame, 1, faults);
  }
  if (faults.empty()) check_unit(frame, faults);
  if (!faults.empty()) return faults.error();
  return {};
}

}  // namespace

Result<void> validate(const Frame& frame) {
  return guard::guarded("validate", [&] { return checked(frame); });
}

}  // namespace flowdlo
