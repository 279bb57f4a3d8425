// FrameFolder: how a frame folder is read and written, with the system calls to do it by.
#pragma once

#include <array>
#include <filesystem>

#include "files/system_calls.hpp"
#include "flowdlo/durability.hpp"
#include "flowdlo/frame_folder.hpp"

namespace flowdlo::frame {

/// Without this file a folder is no frame: it goes first and comes last.
inline constexpr const char* kKeyFile = "camera.json";

inline constexpr std::array<const char*, 6> kFrameFiles = {
    kKeyFile, "depth.png", "mask.png", "color.png", "truth.csv", "instances.png"};

enum class MaskFile {
  kNeeded,
  kNotRead,  ///< the mask is 0 everywhere
};

/// load_frame_folder() or load_frame_folder_without_mask(), and save_frame_folder().
[[nodiscard]] Result<FrameFolder> load_folder(const std::filesystem::path& folder,
                                              const files::SystemCalls& calls,
                                              MaskFile mask = MaskFile::kNeeded);
[[nodiscard]] Result<void> save_folder(const std::filesystem::path& folder, const Frame& frame,
                                       double depth_scale_m, const Centerline* truth,
                                       Durability durability, const files::SystemCalls& calls);

}  // namespace flowdlo::frame
