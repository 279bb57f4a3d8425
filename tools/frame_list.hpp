// FrameList: the frame folders that a command line names, each with the name of its output folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::tools {

struct FrameEntry {
  std::filesystem::path folder;
  std::string name;  ///< unique in its list
};

/// One entry for each of `arguments`; a data set (a folder without camera.json whose folders have
/// one) stands for its frames in the order of their names. A folder that is no frame stays in the
/// list: its estimate says what is wrong. Fails with kBadInput where two frames share a name.
[[nodiscard]] Result<std::vector<FrameEntry>> list_frames(
    const std::vector<std::filesystem::path>& arguments);

}  // namespace flowdlo::tools
