// StagedFiles: files that are all written before any of them gets its name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "files/temporary_file.hpp"

namespace flowdlo::files {

/// Collects files under temporary names beside their destinations; commit() renames them in the
/// order in which they were added. What was not committed is removed with the object. A link in a
/// destination's place is replaced, not followed. For files that must fit each other: FolderUpdate.
class StagedFiles {
 public:
  explicit StagedFiles(Durability durability = Durability::kSynced,
                       const SystemCalls& calls = kernel())
      : durability_(durability), calls_(&calls) {}

  /// Writes `bytes` under a temporary name. Fails with kIo; the folder must exist.
  [[nodiscard]] Result<void> add(const std::filesystem::path& file,
                                 std::span<const std::uint8_t> bytes);
  [[nodiscard]] Result<void> add(const std::filesystem::path& file, std::string_view text);

  /// Gives every file its name, replacing what was there. Fails with kIo at the first that cannot.
  [[nodiscard]] Result<void> commit();

 private:
  [[nodiscard]] Result<const Folder*> folder_of(const std::filesystem::path& file);

  Durability durability_;
  const SystemCalls* calls_;
  std::map<std::filesystem::path, std::unique_ptr<Folder>> folders_;
  std::vector<TemporaryFile> files_;
};

}  // namespace flowdlo::files
