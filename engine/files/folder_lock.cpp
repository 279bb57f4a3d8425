#include "files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <optional>

#include "files/failure.hpp"
#include "files/shown_name.hpp"
#include "files/uninterrupted.hpp"

namespace flowdlo::files {
namespace {

constexpr const char* kLockName = ".flowdlo-lock";
constexpr int kPause_ms = 2;

bool locks_unknown(int code) {
  return code == EBADF || code == EINVAL || code == ENOLCK || code == ENOSYS || code == EOPNOTSUPP;
}

Descriptor opened(const Folder& folder, const char* name, int flags) {
  const SystemCalls& calls = folder.calls();
  return Descriptor(
      uninterrupted([&] { return calls.openat(folder.descriptor(), name, flags, 0666); }), calls);
}

// Zero, or the errno; EWOULDBLOCK: another has had it all the time.
int locked(const Descriptor& descriptor, const SystemCalls& calls) {
  for (int waited_ms = 0;; waited_ms += kPause_ms) {
    if (uninterrupted([&] { return calls.flock(descriptor.get(), LOCK_EX | LOCK_NB); }) == 0) {
      return 0;
    }
    const int code = errno;
    if (code != EWOULDBLOCK || waited_ms >= kLockPatience_ms) return code;
    calls.sleep_ms(kPause_ms);
  }
}

// The lock file is removed by who held it: one that was locked when its name had gone is no lock.
bool still_named(const Folder& folder, const Descriptor& descriptor) {
  struct stat held {};
  const auto named = folder.status(kLockName);
  return uninterrupted([&] { return folder.calls().fstat(descriptor.get(), held); }) == 0 &&
         named && *named && (*named)->st_ino == held.st_ino && (*named)->st_dev == held.st_dev;
}

Error not_locked(const Folder& folder, int code) {
  if (code != EWOULDBLOCK) return failure(folder.path(), "locked", code);
  return {ErrorCode::kIo, shown(folder.path()) +
                              ": another process has been writing it for ten seconds; wait "
                              "for it, or end it"};
}

}  // namespace

Result<FolderLock> FolderLock::take(const Folder& folder) {
  Descriptor own = opened(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (!own.is_open()) return failure(folder.path(), "locked", errno);
  int code = locked(own, folder.calls());
  if (code == 0) return FolderLock(folder, std::move(own), false);
  if (!locks_unknown(code)) return not_locked(folder, code);

  constexpr int kAttempts = 1000;  // each one lost to a writer that has finished since
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Descriptor file = opened(folder, kLockName, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC);
    if (!file.is_open()) return failure(folder.path() / kLockName, "opened", errno);
    code = locked(file, folder.calls());
    if (locks_unknown(code)) {
      (void)folder.remove(kLockName);
      return FolderLock(folder, std::move(own), false);
    }
    if (code != 0) return not_locked(folder, code);
    if (still_named(folder, file)) return FolderLock(folder, std::move(file), true);
  }
  return not_locked(folder, EWOULDBLOCK);
}

FolderLock::~FolderLock() {
  if (is_file_ && descriptor_.is_open()) (void)folder_->remove(kLockName);
}

}  // namespace flowdlo::files
