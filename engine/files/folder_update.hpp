// FolderUpdate: files of one folder that change together, or not at all.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/folder.hpp"
#include "files/temporary_file.hpp"

namespace flowdlo::files {

/// Collects new files under temporary names; commit() puts them in place of the old ones. Whenever
/// the process ends, and whatever call fails, open_together() finds all of the old files or all of
/// the new ones. Files that are not named keep their content; a link to a folder stays one.
///
/// One file is the key: it goes first and comes last, so that a program that knows nothing of
/// records finds no key where it should read nothing.
class FolderUpdate {
 public:
  /// Makes the folder where there is none. Fails with kIo.
  [[nodiscard]] static Result<FolderUpdate> begin(const std::filesystem::path& folder,
                                                  std::string key, Durability durability,
                                                  const SystemCalls& calls = kernel());

  /// Writes a new `name` under a temporary name. Fails with kIo.
  [[nodiscard]] Result<void> put(std::string_view name, std::span<const std::uint8_t> bytes);
  [[nodiscard]] Result<void> put(std::string_view name, std::string_view text);

  /// `name` shall not be there afterwards.
  void remove(std::string_view name) { removes_.emplace_back(name); }

  /// Waits for other writers of the folder, finishes what one that was killed began, and makes the
  /// change. Fails with kIo: nothing has changed then, or all of it, where only what comes after
  /// the record of it failed.
  [[nodiscard]] Result<void> commit();

 private:
  FolderUpdate(std::unique_ptr<Folder> folder, std::string key, Durability durability)
      : folder_(std::move(folder)), key_(std::move(key)), durability_(durability) {}

  [[nodiscard]] Result<void> check_places() const;
  [[nodiscard]] Result<void> write_record(std::string_view text);

  std::unique_ptr<Folder> folder_;  ///< behind a pointer, for the files' sake
  std::string key_;
  Durability durability_;
  std::vector<TemporaryFile> puts_;
  std::vector<std::string> removes_;
};

}  // namespace flowdlo::files
