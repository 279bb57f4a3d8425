// StripStore: strips along hypotheses of synthetic frames, beside where the rope truly is.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/result.hpp"
#include "refine/strip.hpp"
#include "refining/recipe.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::refining {

inline constexpr std::uint64_t kShardScenes = 10;

/// What a strip is compared with. Nodes and truth have the same index, in the better direction.
struct StripTruth {
  std::uint64_t scene = 0;
  float matched = 0;                 ///< 1: the depth is matched
  float radius_m = 0;                ///< of the rope, as the mask has it
  float index_mm = 0;                ///< Eq. (4.1), in the better direction
  std::array<float, kNodes> deep{};  ///< from node to truth, radii, as all three
  std::array<float, kNodes> aside{};
  std::array<float, kNodes> along{};
};

struct StripSample {
  StripTruth truth;
  refine::Strip strip;
  /// Deep, radii: the way of each node to the table, from its share of it in the strip.
  std::array<float, kNodes> to_table{};
};

/// Makes the shards that are not in `folder` yet, `threads` at work: of each scene with a path the
/// hypothesis that the gate takes. `progress` is called after each scene, from one thread at a
/// time. Fails with kIo, or as the scene maker does.
[[nodiscard]] Result<void> make_strips(const std::filesystem::path& folder,
                                       const DataConfig& config,
                                       std::shared_ptr<const weights::FieldWeights> field,
                                       int threads, const std::function<void()>& progress);

/// All shards of a folder. Fails with kIo or kBadInput, the latter also where there are none.
[[nodiscard]] Result<std::vector<StripSample>> read_strips(const std::filesystem::path& folder);

}  // namespace flowdlo::refining
