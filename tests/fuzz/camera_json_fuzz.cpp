// camera.json: an error, or a camera that is written and read again without loss.
#include <string>

#include "frame/camera_json.hpp"
#include "frame/limits.hpp"
#include "promise.hpp"
#include "target.hpp"

using flowdlo::fuzz::promise;
namespace frame = flowdlo::frame;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto camera =
      frame::parse_camera({reinterpret_cast<const char*>(data), size}, "camera.json");
  if (!camera) {
    promise(camera.error().message.starts_with("camera.json: "), "an error names its file");
    return 0;
  }
  const auto& [fx, fy, cx, cy] = camera->intrinsics;
  promise(fx >= frame::kMinFocal_px && fx <= frame::kMaxFocal_px, "fx is usable");
  promise(fy >= frame::kMinFocal_px && fy <= frame::kMaxFocal_px, "fy is usable");
  promise(camera->depth_scale_m > 0 && camera->depth_scale_m <= frame::kMaxDepthScale_m,
          "the depth scale is usable");
  if (camera->width == 0 || camera->height == 0) return 0;  // BOP's form, which may leave them out
  const auto again = frame::parse_camera(frame::format_camera(*camera), "again");
  promise(again.has_value(), "a camera that was read can be written and read");
  promise(again->intrinsics.fx == fx && again->intrinsics.fy == fy && again->intrinsics.cx == cx &&
              again->intrinsics.cy == cy && again->width == camera->width &&
              again->height == camera->height && again->depth_scale_m == camera->depth_scale_m,
          "reading it again gives the same numbers");
  return 0;
}
