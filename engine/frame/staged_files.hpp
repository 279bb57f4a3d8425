// StagedFiles: files that appear together, whole, or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// Collects files under temporary names beside their destinations; commit() renames them in the
/// order in which they were added. What was not committed is removed with the object.
class StagedFiles {
 public:
  StagedFiles() = default;
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;
  ~StagedFiles();

  /// Writes `bytes` under a temporary name. Fails with kIo; the folder must exist.
  Result<void> add(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
  Result<void> add(const std::filesystem::path& file, std::string_view text);

  /// Gives every file its name, replacing what was there. Fails with kIo at the first that cannot.
  Result<void> commit();

 private:
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> temporary_and_final_;
};

}  // namespace flowdlo::frame
