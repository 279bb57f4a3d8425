// RecordFolder: the cached records of one recipe, in shards that can grow while training runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "train/record_file.hpp"
#include "train/scene_source.hpp"

namespace flowdlo::train {

inline constexpr std::uint32_t kShardScenes = 100;

/// What a part's shards hold together.
struct RecordSet {
  std::string origin;
  std::vector<Record> records;  ///< in the order of scenes
  std::uint64_t scenes = 0;
  std::uint64_t skipped = 0;  ///< scenes in which no path was found
  std::string sha256;         ///< of the shards' digests, in order
  std::uint32_t shards = 0;
};

/// Called after each scene, from one thread at a time.
using Progress = std::function<void()>;

/// Makes the shards of scenes [0, scenes) that are not there yet, `threads` at work. `scenes` is
/// rounded up to whole shards, as far as the part goes. Fails with
/// kBadInput when `folder` holds records of another origin, engine or scene maker, with kIo when it
/// cannot be written.
[[nodiscard]] Result<void> make_records(const std::filesystem::path& folder, Part part,
                                        std::uint64_t scenes, const SourceConfig& source,
                                        const RecordOptions& options, int threads,
                                        const Progress& progress);

/// Shards 0, 1, ... as far as they are there, at most `most_shards`. Fails with kBadInput when
/// there is none, or one is damaged or of another origin than the first.
[[nodiscard]] Result<RecordSet> load_records(const std::filesystem::path& folder, Part part,
                                             std::uint32_t most_shards = 0xFFFFFFFFU);

/// How many consecutive shards lie in `folder`.
[[nodiscard]] std::uint32_t count_shards(const std::filesystem::path& folder, Part part);

}  // namespace flowdlo::train
