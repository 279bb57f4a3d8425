#include "files/folder.hpp"

#include <fcntl.h>

#include <cerrno>

#include "files/failure.hpp"
#include "files/uninterrupted.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kEveryone = 0777;  // less the process's umask

int make_one(const fs::path& path, const SystemCalls& calls) {
  const int made = uninterrupted([&] { return calls.mkdirat(AT_FDCWD, path.c_str(), kEveryone); });
  return made == 0 || errno == EEXIST ? 0 : errno;
}

// From the top down; what is there already is left alone. Zero, or the errno.
int make_all(const fs::path& path, const SystemCalls& calls) {
  if (path.empty()) return 0;
  int code = make_one(path, calls);
  if (code != ENOENT) return code;
  fs::path above = path.parent_path();
  if (!path.has_filename()) above = above.parent_path();  // "a/b/" is a/b
  if (above.empty() || above == path) return code;
  code = make_all(above, calls);
  return code == 0 ? make_one(path, calls) : code;
}

}  // namespace

int synced(int file, Durability durability, const SystemCalls& calls) {
  if (durability == Durability::kUnsynced) return 0;
  if (uninterrupted([&] { return calls.fsync(file); }) == 0) return 0;
  const bool unknown = errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP;
  return unknown ? 0 : errno;
}

Result<Folder> Folder::open(const fs::path& path, const SystemCalls& calls) {
  const char* name = path.empty() ? "." : path.c_str();
  constexpr int kFlags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
  Descriptor descriptor(uninterrupted([&] { return calls.openat(AT_FDCWD, name, kFlags, 0); }),
                        calls);
  if (!descriptor.is_open()) return failure(name, "opened as a folder", errno);
  return Folder(std::move(descriptor), path, calls);
}

Result<Folder> Folder::make(const fs::path& path, const SystemCalls& calls) {
  if (const int code = make_all(path, calls); code != 0) return failure(path, "made", code);
  return open(path, calls);
}

Result<std::optional<struct stat>> Folder::status(const std::string& name) const {
  struct stat status {};
  const int got = uninterrupted(
      [&] { return calls_->fstatat(descriptor(), name.c_str(), status, AT_SYMLINK_NOFOLLOW); });
  if (got == 0) return std::optional(status);
  if (errno == ENOENT) return std::optional<struct stat>();
  return failure(path_ / name, "looked at", errno);
}

Result<std::vector<std::string>> Folder::names() const {
  std::vector<std::string> names;
  const int listed = uninterrupted([&] {
    names.clear();
    return calls_->list(descriptor(), names);
  });
  if (listed != 0) return failure(path_, "listed", errno);
  return names;
}

Result<void> Folder::rename(const std::string& from, const std::string& to) const {
  const int renamed =
      uninterrupted([&] { return calls_->renameat(descriptor(), from.c_str(), to.c_str()); });
  if (renamed != 0) return failure(path_ / to, "replaced", errno);
  return {};
}

Result<void> Folder::remove(const std::string& name) const {
  const int removed = uninterrupted([&] { return calls_->unlinkat(descriptor(), name.c_str()); });
  if (removed != 0 && errno != ENOENT) return failure(path_ / name, "removed", errno);
  return {};
}

Result<void> Folder::sync(Durability durability) const {
  const int code = synced(descriptor(), durability, *calls_);
  if (code != 0) return failure(path_, "brought to its disk", code);
  return {};
}

}  // namespace flowdlo::files
