#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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
Result<std::vector<std::uint16_t>> units_of(const Frame& frame, double scale_m) {
  std::vector<std::uint16_t> units;
  units.reserve(frame.depth_m.size());
  std::size_t too_far = 0;
  for (const float z_m : frame.depth_m) {
    const double unit = std::isfinite(z_m) && z_m > 0 ? std::round(z_m / scale_m) : 0;
    if (unit > frame::kMaxDepthUnit) ++too_far;
    units.push_back(static_cast<std::uint16_t>(std::min<double>(unit, frame::kMaxDepthUnit)));
  }
  if (too_far == 0) return units;
  return Error{
      ErrorCode::kBadInput,
      fmt::format("Frame.depth_m: expected at most {:.6g} m ({} steps of {:.6g} m), got {} "
                  "pixels beyond; choose a larger depth_scale",
                  frame::kMaxDepthUnit * scale_m, frame::kMaxDepthUnit, scale_m, too_far)};
}

template <class Value>
Result<void> put_png(files::FolderUpdate& update, const char* name, const Frame& frame,
                     std::span<const Value> values, int channels = 1) {
  const auto stride = static_cast<std::size_t>(frame.width) * channels * sizeof(Value);
  const auto bytes =
      frame::encode_png({frame.width, frame.height, channels, 8 * static_cast<int>(sizeof(Value))},
                        values.data(), stride);
  if (!bytes) return bytes.error();
  return update.put(name, *bytes);
}

// A frame must not keep the colour, the labels or the truth of the one that stood here before.
Result<void> put_all(files::FolderUpdate& update, const Frame& frame, double depth_scale_m,
                     const Centerline* truth, std::span<const std::uint16_t> units) {
  if (auto done = put_png(update, "depth.png", frame, units); !done) return done;
  if (auto done = put_png(update, "mask.png", frame, frame.mask); !done) return done;
  if (frame.color_bgr.empty()) {
    update.remove("color.png");
  } else {
    if (auto done = put_png(update, "color.png", frame, frame.color_bgr, 3); !done) return done;
  }
  if (frame.instances.empty()) {
    update.remove("instances.png");
  } else {
    auto done = put_png(update, "instances.png", frame, frame.instances);
    if (!done) return done;
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
