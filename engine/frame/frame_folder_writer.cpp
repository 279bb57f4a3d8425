#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "files/folder_update.hpp"
#include "flowdlo/frame_folder.hpp"
#include "frame/camera_json.hpp"
#include "frame/centerline_csv.hpp"
#include "frame/frame_folder.hpp"
#include "frame/limits.hpp"
#include "frame/png.hpp"
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

Result<void> put_png(files::FolderUpdate& update, const char* name, const cv::Mat& image) {
  const auto bytes = frame::encode_png(image);
  if (!bytes) return bytes.error();
  return update.put(name, *bytes);
}

template <class Pixel>
cv::Mat mat_over(std::span<const Pixel> pixels, const Frame& frame, int type) {
  // OpenCV has no view of constant pixels; the callers only read.
  return {frame.height, frame.width, type, const_cast<Pixel*>(pixels.data())};
}

// A frame must not keep the colour, the labels or the truth of the one that stood here before.
Result<void> put_all(files::FolderUpdate& update, const Frame& frame, double depth_scale_m,
                     const Centerline* truth, const cv::Mat& units) {
  if (auto done = put_png(update, "depth.png", units); !done) return done;
  const auto mask = mat_over(frame.mask, frame, CV_8UC1);
  if (auto done = put_png(update, "mask.png", mask); !done) return done;
  if (frame.color_bgr.empty()) {
    update.remove("color.png");
  } else {
    const auto color = mat_over(frame.color_bgr, frame, CV_8UC3);
    if (auto done = put_png(update, "color.png", color); !done) return done;
  }
  if (frame.instances.empty()) {
    update.remove("instances.png");
  } else {
    const auto instances = mat_over(frame.instances, frame, CV_16UC1);
    if (auto done = put_png(update, "instances.png", instances); !done) return done;
  }
  if (truth == nullptr) {
    update.remove("truth.csv");
  } else if (auto done = update.put("truth.csv", frame::format_centerline(*truth)); !done) {
    return done;
  }
  return update.put(frame::kKeyFile, frame::format_camera({frame.width, frame.height,
                                                           frame.intrinsics, depth_scale_m}));
}

}  // namespace

Result<void> frame::save_folder(const fs::path& folder, const Frame& frame, double depth_scale_m,
                                const Centerline* truth, Durability durability,
                                const files::SystemCalls& calls) {
  if (auto valid = validate(frame); !valid) return valid;
  if (!(depth_scale_m > 0 && depth_scale_m <= kMaxDepthScale_m)) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("save_frame_folder: depth_scale: expected metres a unit, over 0 and at "
                    "most {}, got {}",
                    kMaxDepthScale_m, depth_scale_m)};
  }
  const auto units = units_of(frame, depth_scale_m);
  if (!units) return units.error();
  auto update = files::FolderUpdate::begin(folder, kKeyFile, durability, calls);
  if (!update) return update.error();
  if (auto done = put_all(*update, frame, depth_scale_m, truth, *units); !done) return done;
  return update->commit();
}

Result<void> save_frame_folder(const fs::path& folder, const Frame& frame, double depth_scale,
                               const Centerline* truth, Durability durability) {
  return guard::guarded("save_frame_folder", [&] {
    return frame::save_folder(folder, frame, depth_scale, truth, durability, files::kernel());
  });
}

}  // namespace flowdlo
