// FolderLock: one writer at a time in a folder, among all processes and threads.
#pragma once

#include <string>

#include "files/folder.hpp"

namespace flowdlo::files {

/// Held until it goes; the system gives it back when its process ends, however that ends. Readers
/// need none. Where the file system locks no folders (NFS), a file ".flowdlo-lock" is locked in its
/// place and removed afterwards; where it locks nothing at all, nobody waits.
class FolderLock {
 public:
  /// Waits for at most kLockPatience_ms. Fails with kIo. `folder` must outlive the lock.
  [[nodiscard]] static Result<FolderLock> take(const Folder& folder);

  FolderLock(FolderLock&& other) noexcept = default;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  FolderLock(const Folder& folder, Descriptor descriptor, bool is_file)
      : folder_(&folder), descriptor_(std::move(descriptor)), is_file_(is_file) {}

  const Folder* folder_;
  Descriptor descriptor_;  ///< its own opening: a lock belongs to one
  bool is_file_;
};

constexpr int kLockPatience_ms = 10000;  ///< a writer holds it for the time of some renames

}  // namespace flowdlo::files
