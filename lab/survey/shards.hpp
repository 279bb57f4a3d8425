// Shards: packed samples of training scenes on disk, so many scenes a file. They can grow while
// training runs.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <vector>

#include "flowdlo/result.hpp"
#include "survey/in_parallel.hpp"
#include "survey/packed.hpp"

namespace flowdlo::survey {

struct ShardKind {
  std::uint64_t magic = 0;
  const char* name = "";      ///< of what is in them: "patches"
  const char* maker = "";     ///< the command that makes them
  std::uint64_t scenes = 50;  ///< of a shard
};

[[nodiscard]] std::filesystem::path shard_file(const std::filesystem::path& folder,
                                               const ShardKind& kind, std::uint64_t shard);
[[nodiscard]] Result<void> write_shard(const std::filesystem::path& file, const ShardKind& kind,
                                       const std::vector<Bytes>& samples);
/// Fails with kIo.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);
/// Says which file is no such shard.
[[nodiscard]] Error damaged(const std::filesystem::path& file, const ShardKind& kind);

/// Makes the shards of scenes [0, scenes) that are not in `folder` yet, several at a time.
/// `pack(tool, scene)` gives a scene's samples, a Result<std::vector<Bytes>>; tools are
/// in_parallel's. `progress` is called after each scene, from one thread at a time. Fails with kIo,
/// or as `pack` and `make_tool` do.
template <class MakeTool, class Pack>
[[nodiscard]] Result<void> make_shards(const std::filesystem::path& folder, const ShardKind& kind,
                                       std::uint64_t scenes, int threads, const MakeTool& make_tool,
                                       const Pack& pack, const std::function<void()>& progress) {
  if (auto made = make_folder(folder); !made) return made;
  std::mutex mutex;
  std::atomic<bool> failed = false;
  const auto advance = [&] {
    const std::lock_guard lock(mutex);
    progress();
  };
  const auto make = [&](auto& tool, std::uint64_t shard) -> Result<Nothing> {
    const auto file = shard_file(folder, kind, shard);
    const bool there = std::filesystem::exists(file);
    std::vector<Bytes> all;
    for (std::uint64_t i = 0; i < kind.scenes && !failed; ++i) {
      if (!there) {
        auto samples = pack(tool, shard * kind.scenes + i);
        if (!samples) {
          failed = true;
          return samples.error();
        }
        for (Bytes& sample : *samples) all.push_back(std::move(sample));
      }
      advance();
    }
    if (there || failed) return Nothing();
    const auto written = write_shard(file, kind, all);
    return written ? Result<Nothing>(Nothing()) : written.error();
  };
  const std::uint64_t shards = (scenes + kind.scenes - 1) / kind.scenes;
  for (const auto& done : in_parallel<Nothing>({0, shards}, threads, make_tool, make)) {
    if (!done) return done.error();
  }
  return {};
}

/// The samples of a folder, read one by one when they are asked for.
class ShardStore {
 public:
  /// Shards 0, 1, ... as far as they are there. Fails with kBadInput where there is none or one is
  /// damaged, with kIo where one cannot be read.
  [[nodiscard]] static Result<ShardStore> open(const std::filesystem::path& folder,
                                               const ShardKind& kind);

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const std::filesystem::path& file_of(std::size_t sample) const {
    return files_[places_[sample].shard];
  }

  /// Fails with kIo.
  [[nodiscard]] Result<Bytes> read(std::size_t sample) const;

 private:
  struct Place {
    std::size_t shard = 0;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
  };

  std::vector<std::filesystem::path> files_;
  std::vector<Place> places_;
};

}  // namespace flowdlo::survey
