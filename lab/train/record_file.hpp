// RecordFile: a shard of records on disk, verified by a digest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "train/record.hpp"

namespace flowdlo::train {

struct Shard {
  std::string origin;         ///< what made the records, in words; shards of one set share it
  std::uint64_t first = 0;    ///< index of the first scene
  std::uint32_t scenes = 0;   ///< looked at; records.size() + skipped
  std::uint32_t skipped = 0;  ///< of them without a path or evidence
  std::vector<Record> records;
  std::string sha256;  ///< of the file's payload; set by read and write
};

/// Under a temporary name, then renamed. Fails with kIo.
[[nodiscard]] Result<void> write_shard(Shard& shard, const std::filesystem::path& file);

/// Fails with kIo, or kBadInput when the file is damaged or of another version.
[[nodiscard]] Result<Shard> read_shard(const std::filesystem::path& file);

}  // namespace flowdlo::train
