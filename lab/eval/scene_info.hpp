// SceneInfo: what meta.json says of a frame, as far as tables group by it.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::eval {

struct SceneInfo {
  std::string scenario = "unknown";
  std::string material = "unknown";
  std::set<std::string> defects;  ///< names of the switches in "defects" that are on
  bool described = false;         ///< meta.json has defects: easy() and hard() mean something
  int crossings = 0;
  double gap_widths = 0;  ///< longest stretch of the rope that nothing shows, in its widths

  [[nodiscard]] bool has(const std::string& defect) const { return defects.count(defect) > 0; }
  /// Gap, touching strands, coil, or depth holes: where geometry has to guess.
  [[nodiscard]] bool hard() const;
  /// No crossing, no gap, no bad depth, nothing hidden.
  [[nodiscard]] bool easy() const;
};

/// Reads `folder`/meta.json; a frame without one is of the scenario "unknown". Fails with kBadInput
/// when the file is no JSON object or a field has the wrong type.
[[nodiscard]] Result<SceneInfo> read_scene_info(const std::filesystem::path& folder);

}  // namespace flowdlo::eval
