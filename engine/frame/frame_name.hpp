// The name of a frame: that of its folder.
#pragma once

#include <filesystem>
#include <string>

namespace flowdlo::frame {

/// "scenes/a", "scenes/a/" and "." inside scenes/a are all "a". Symbolic links keep their own name.
inline std::string frame_name(const std::filesystem::path& folder) {
  std::error_code ignored;
  auto path = std::filesystem::absolute(folder, ignored).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return path.filename().string();
}

}  // namespace flowdlo::frame
