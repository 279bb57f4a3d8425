// PatchStore: patches on disk, in shards that can grow while training runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <utility>

#include "flowdlo/result.hpp"
#include "strand/patch.hpp"
#include "survey/shards.hpp"

namespace flowdlo::strand {

inline constexpr std::uint64_t kShardScenes = 50;

/// What patches are made of: scenes [0, scenes) of the training part.
struct DataConfig {
  std::uint64_t seed = 0;
  std::uint64_t scenes = 8000;  ///< rounded up to whole shards
  double several = 0;           ///< share of them, evenly spread, that show two to nine ropes
  double tangled = 0;           ///< likewise, that show two to six looped or coiled ones
  double drawn = 0;             ///< likewise, that are drawn by a plain z-buffer, not rendered
  double touching = 0;          ///< likewise, that show a ring whose ends touch
  double matched = 0;           ///< likewise, whose stereo camera matches two infrared pictures
  double cords = 0;             ///< likewise, whose ropes are as synth::Render::cords has them
  PatchConfig patch;
};

/// Makes the shards that are not in `folder` yet, `threads` at work. `progress` is called after
/// each scene, from one thread at a time. Fails with kIo, or as patches_of does.
[[nodiscard]] Result<void> make_patches(const std::filesystem::path& folder,
                                        const DataConfig& config, int threads,
                                        const std::function<void()>& progress);

/// The patches of a folder, read one by one when they are asked for.
class PatchStore {
 public:
  /// Shards 0, 1, ... as far as they are there. Fails with kBadInput where there is none or one is
  /// damaged, with kIo where one cannot be read.
  [[nodiscard]] static Result<PatchStore> open(const std::filesystem::path& folder);

  [[nodiscard]] std::size_t size() const { return store_.size(); }

  /// Fails with kIo and kBadInput.
  [[nodiscard]] Result<Patch> read(std::size_t index) const;

 private:
  explicit PatchStore(survey::ShardStore store) : store_(std::move(store)) {}

  survey::ShardStore store_;
};

}  // namespace flowdlo::strand
