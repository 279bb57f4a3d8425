// MatFile: OpenCV's images as PNG files.
#pragma once

#include <filesystem>

#include "files/whole_file.hpp"
#include "mat/mat_png.hpp"

namespace flowdlo::mat {

/// Writes `image` under a temporary name, then renames it. Fails with kIo, and as encode_png.
[[nodiscard]] inline Result<void> save_png(const std::filesystem::path& file, const cv::Mat& image,
                                           Durability durability = Durability::kUnsynced) {
  const auto bytes = encode_png(image);
  if (!bytes) return bytes.error();
  return files::write_file(file, {*bytes}, durability);
}

}  // namespace flowdlo::mat
