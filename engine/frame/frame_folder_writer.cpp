#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <system_error>

#include "flowdlo/frame_folder.hpp"
#include "frame/camera_json.hpp"
#include "frame/centerline_csv.hpp"
#include "frame/limits.hpp"
#include "frame/png.hpp"
#include "frame/staged_files.hpp"
#include "guard/guarded.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;

// To the nearest unit; 0 where there is no depth.
Result<cv::Mat> units_of(const Frame& frame, double scale_m) {
  cv::Mat units(frame.height, frame.width, CV_16UC1);
  std::size_t too_far = 0;
  for (int v = 0; v < frame.height; ++v) {
    auto* row = units.ptr<std::uint16_t>(v);
    for (int u = 0; u < frame.width; ++u) {
      const float z_m = frame.depth_m[static_cast<std::size_t>(v) * frame.width + u];
      const double unit = std::isfinite(z_m) && z_m > 0 ? std::round(z_m / scale_m) : 0;
      if (unit > frame::kMaxDepthUnit) ++too_far;
      row[u] = static_cast<std::uint16_t>(std::min<double>(unit, frame::kMaxDepthUnit));
    }
  }
  if (too_far == 0) return units;
  return Error{
      ErrorCode::kBadInput,
      fmt::format("Frame.depth_m: expected at most {:.6g} m ({} steps of {:.6g} m), got {} "
                  "pixels beyond; choose a larger depth_scale",
                  frame::kMaxDepthUnit * scale_m, frame::kMaxDepthUnit, scale_m, too_far)};
}

Result<void> stage_png(frame::StagedFiles& staged, const fs::path& file, const cv::Mat& image) {
  const auto bytes = frame::encode_png(image);
  if (!bytes) return bytes.error();
  return staged.add(file, *bytes);
}

template <class Pixel>
cv::Mat mat_over(std::span<const Pixel> pixels, const Frame& frame, int type) {
  // OpenCV has no view of constant pixels; the callers only read.
  return {frame.height, frame.width, type, const_cast<Pixel*>(pixels.data())};
}

Result<void> stage_all(frame::StagedFiles& staged, const fs::path& folder, const Frame& frame,
                       double depth_scale_m, const Centerline* truth) {
  const auto units = units_of(frame, depth_scale_m);
  if (!units) return units.error();
  if (auto done = stage_png(staged, folder / "depth.png", *units); !done) return done;
  const auto mask = mat_over(frame.mask, frame, CV_8UC1);
  if (auto done = stage_png(staged, folder / "mask.png", mask); !done) return done;
  if (!frame.color_bgr.empty()) {
    const auto color = mat_over(frame.color_bgr, frame, CV_8UC3);
    if (auto done = stage_png(staged, folder / "color.png", color); !done) return done;
  }
  if (truth != nullptr) {
    if (auto done = staged.add(folder / "truth.csv", frame::format_centerline(*truth)); !done) {
      return done;
    }
  }
  return staged.add(
      folder / "camera.json",
      frame::format_camera({frame.width, frame.height, frame.intrinsics, depth_scale_m}));
}

// A frame must not keep the colour or the truth of the one that stood here before.
void remove_stale(const fs::path& folder, const Frame& frame, const Centerline* truth) {
  std::error_code ignored;
  if (frame.color_bgr.empty()) fs::remove(folder / "color.png", ignored);
  if (truth == nullptr) fs::remove(folder / "truth.csv", ignored);
}

Result<void> save(const fs::path& folder, const Frame& frame, double depth_scale,
                  const Centerline* truth) {
  if (auto valid = validate(frame); !valid) return valid;
  if (!(depth_scale > 0 && depth_scale <= frame::kMaxDepthScale_m)) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("save_frame_folder: depth_scale: expected metres a unit, over 0 and at "
                    "most {}, got {}",
                    frame::kMaxDepthScale_m, depth_scale)};
  }
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    return Error{ErrorCode::kIo, folder.string() + ": cannot be made: " + failure.message()};
  }
  frame::StagedFiles staged;
  if (auto done = stage_all(staged, folder, frame, depth_scale, truth); !done) return done;
  remove_stale(folder, frame, truth);
  return staged.commit();
}

}  // namespace

Result<void> save_frame_folder(const fs::path& folder, const Frame& frame, double depth_scale,
                               const Centerline* truth) {
  return guard::guarded("save_frame_folder",
                        [&] { return save(folder, frame, depth_scale, truth); });
}

}  // namespace flowdlo
