// Parts: what each part of the estimator adds, one switched on after the other.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "eval/scene_info.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// What one part made of one frame.
struct PartOutcome {
  double index_m = 0;              ///< index error, Eq. (4.1), in the published direction
  std::vector<double> hidden_m{};  ///< distance of each node whose true place is off the mask, in
                                   ///< the better direction
  bool draw = false;               ///< the nodes are a draw of the model
  double total_ms = 0;
};

/// The estimator with some of its parts; an entry a frame, the same frames in each.
struct Part {
  std::string name;
  std::vector<PartOutcome> outcomes{};
};

struct Parts {
  std::vector<SceneInfo> scenes;
  std::vector<Part> parts;
};

/// Of Parts::parts, what all others are compared with.
inline constexpr std::size_t kDefaultPart = 4;

/// How many times each frame is estimated.
[[nodiscard]] std::size_t count_of_parts();

/// Frames without truth, and those that give no estimate with some part, are left out. `advance` is
/// called once a frame and part. Fails as Estimator::create does.
[[nodiscard]] Result<Parts> measure_parts(const Config& config,
                                          std::span<const std::filesystem::path> frames,
                                          const std::function<void()>& advance);

/// A table in Markdown: parts by groups of scenes.
[[nodiscard]] std::string parts_markdown(const Parts& parts);

}  // namespace flowdlo::eval
