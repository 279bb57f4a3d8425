// FrameFolder: a frame on disk (color.png, depth.png, mask.png, instances.png, camera.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/durability.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// A frame that owns its pixels.
struct FrameFolder {
  std::string name;  ///< the folder's own name
  int width = 0;
  int height = 0;
  Intrinsics intrinsics;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color_bgr;
  std::optional<Centerline> truth;         ///< truth.csv, when present
  std::vector<std::uint16_t> instances{};  ///< instances.png, when present

  /// Views into this object: keep it alive while the frame is used.
  [[nodiscard]] Frame frame() const {
    return {width, height, intrinsics, depth_m, mask, color_bgr, instances};
  }
};

/// Reads `folder`. camera.json may be our own form, BOP's (cam_K, depth_scale in mm) or Open3D's
/// (intrinsic_matrix, column-major; depth_scale 0.001 when it has none). color.png, truth.csv
/// and instances.png (8 or 16 bits, one channel) may be absent; of a coloured mask.png the largest
/// channel counts. Fails with kIo or kBadInput,
/// naming the file and the remedy; every fault found is listed. Beside a save_frame_folder(), or
/// after one that was cut off, it is all of the earlier frame or all of the later one.
[[nodiscard]] FLOWDLO_EXPORT Result<FrameFolder> load_frame_folder(
    const std::filesystem::path& folder);

/// The same of a folder whose mask is still to be made (mask.hpp): mask.png is not read and may be
/// absent, the frame's mask is 0 everywhere.
[[nodiscard]] FLOWDLO_EXPORT Result<FrameFolder> load_frame_folder_without_mask(
    const std::filesystem::path& folder);

/// Writes `frame` (and `truth`, when given) as a frame folder. The folder changes as a whole or not
/// at all, whatever fails and whenever the process ends; other files in it stay. Depth is rounded
/// to the nearest step of `depth_scale` metres, and is 0 where there is none. Fails with kIo, or
/// with kBadInput when the frame is not valid or lies beyond 65535 steps.
[[nodiscard]] FLOWDLO_EXPORT Result<void> save_frame_folder(
    const std::filesystem::path& folder, const Frame& frame, double depth_scale,
    const Centerline* truth = nullptr, Durability durability = Durability::kSynced);

}  // namespace flowdlo
