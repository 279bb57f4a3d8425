// Folder: a folder that is held open, so that its path may change under it and nothing goes astray.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/descriptor.hpp"
#include "flowdlo/durability.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::files {

class Folder {
 public:
  /// Follows links. An empty path is the process's own folder. Fails with kIo.
  [[nodiscard]] static Result<Folder> open(const std::filesystem::path& path,
                                           const SystemCalls& calls = kernel());

  /// The same, made before where it was not there, with the folders above it.
  [[nodiscard]] static Result<Folder> make(const std::filesystem::path& path,
                                           const SystemCalls& calls = kernel());

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] const SystemCalls& calls() const { return *calls_; }

  /// What has this name, a link itself rather than its target; none: nothing has. Fails with kIo.
  [[nodiscard]] Result<std::optional<struct stat>> status(const std::string& name) const;

  [[nodiscard]] Result<std::vector<std::string>> names() const;

  /// `from` becomes `to`, in place of what was there.
  [[nodiscard]] Result<void> rename(const std::string& from, const std::string& to) const;

  /// Removes a file or a link; that there is none is no failure.
  [[nodiscard]] Result<void> remove(const std::string& name) const;

  /// Waits until the names are on the disk, where the file system can say so.
  [[nodiscard]] Result<void> sync(Durability durability) const;

 private:
  Folder(Descriptor descriptor, std::filesystem::path path, const SystemCalls& calls)
      : descriptor_(std::move(descriptor)), path_(std::move(path)), calls_(&calls) {}

  Descriptor descriptor_;
  std::filesystem::path path_;
  const SystemCalls* calls_;
};

/// fsync, where `durability` wants it and the file system has it: 0, or the errno.
[[nodiscard]] int synced(int file, Durability durability, const SystemCalls& calls);

}  // namespace flowdlo::files
