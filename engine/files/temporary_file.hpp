// TemporaryFile: a new file under a name that nobody can guess, before it gets its own.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "files/folder.hpp"

namespace flowdlo::files {

/// Which hand may sweep a name that was left behind.
enum class TemporaryKind {
  kSingle,  ///< ".flowdlo-HEX.tmp": anyone, once it is old
  kPart,    ///< ".flowdlo-HEX.part": who holds the folder's lock, once no commit names it
};

constexpr mode_t kNewFile = 0666;  ///< less the process's umask

/// A file that is being written. Removed with its owner unless keep() or rename_to() came first.
class TemporaryFile {
 public:
  /// Fails with kIo; `meant_for` is the name in its messages. `folder` must outlive it.
  [[nodiscard]] static Result<TemporaryFile> create(const Folder& folder, TemporaryKind kind,
                                                    std::string_view meant_for);

  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& meant_for() const { return meant_for_; }
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

  [[nodiscard]] Result<void> write(std::span<const std::uint8_t> bytes);

  /// Nothing more is written. Fails with kIo where the system lost some of it.
  [[nodiscard]] Result<void> finish(Durability durability);

  /// Takes the place of `meant_for`, whatever was there.
  [[nodiscard]] Result<void> take_place();

  /// Somebody else will name it or remove it.
  void keep() { name_.clear(); }

 private:
  TemporaryFile(const Folder& folder, std::string name, Descriptor descriptor,
                std::string_view meant_for);

  const Folder* folder_;
  std::string name_;  ///< empty: no longer ours
  Descriptor descriptor_;
  std::string meant_for_;
};

/// Whether `name` is one that create() gives.
[[nodiscard]] bool is_temporary(std::string_view name, TemporaryKind kind);

/// Removes our own temporary files of `kind` that are older than kStaleAge_s: what killed processes
/// left. Regular files of this user alone; what cannot be removed stays.
void sweep(const Folder& folder, TemporaryKind kind);

constexpr std::int64_t kStaleAge_s = 15 * 60;  ///< since its last byte; no writer pauses so long

}  // namespace flowdlo::files
