#include "files/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <string>

#include "files/broken_pipe.hpp"
#include "files/failure.hpp"
#include "files/folder.hpp"
#include "files/shown_name.hpp"
#include "files/temporary_file.hpp"
#include "files/uninterrupted.hpp"
#include "files/written.hpp"

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;
using Parts = std::vector<std::span<const std::uint8_t>>;

constexpr int kMostLinks = 40;  // as the system has it
constexpr mode_t kPermissions = 0777;
constexpr int kPause_ms = 10;

int status_of(const fs::path& path, struct stat& status, int flags, const SystemCalls& calls) {
  return uninterrupted([&] { return calls.fstatat(AT_FDCWD, path.c_str(), status, flags); });
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

/// Where the links at the end of `file` lead, whether or not anything is there.
Result<fs::path> followed(fs::path file, const SystemCalls& calls) {
  for (int hop = 0; hop < kMostLinks; ++hop) {
    struct stat status {};
    if (status_of(file, status, AT_SYMLINK_NOFOLLOW, calls) != 0) {
      if (errno == ENOENT) return file;
      return failure(file, "written", errno);
    }
    if (!S_ISLNK(status.st_mode)) return file;
    std::array<char, 4096> target{};
    const auto size = uninterrupted(
        [&] { return calls.readlinkat(AT_FDCWD, file.c_str(), target.data(), target.size()); });
    if (size < 0) return failure(file, "followed", errno);
    file =
        file.parent_path() / fs::path(std::string(target.data(), static_cast<std::size_t>(size)));
  }
  return failure(file, "followed", ELOOP);
}

// Whether it is where our own standard output or standard error goes: `> report --json /dev/stdout`
// adds to the report.
bool is_our_output(const struct stat& status, const SystemCalls& calls) {
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat ours {};
    const int got = uninterrupted([&] { return calls.fstat(file, ours); });
    if (got == 0 && is_same(ours, status)) return true;
  }
  return false;
}

// A pipe without a reader cannot be opened; its reader may be about to start.
Descriptor opened_for_writing(const fs::path& file, int flags, const SystemCalls& calls) {
  for (int waited_ms = 0;; waited_ms += kPause_ms) {
    const int descriptor =
        uninterrupted([&] { return calls.openat(AT_FDCWD, file.c_str(), flags, 0); });
    if (descriptor >= 0 || errno != ENXIO || waited_ms >= kPatience_ms) return {descriptor, calls};
    calls.sleep_ms(kPause_ms);
  }
}

/// Into what is there, as it stands.
Result<void> write_through(const fs::path& file, int how, const Parts& parts,
                           const SystemCalls& calls) {
  constexpr int kFlags = O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  const BrokenPipe no_signal;
  auto descriptor = opened_for_writing(file, kFlags | how, calls);
  if (!descriptor.is_open()) return failure(file, "opened", errno);
  for (const auto part : parts) {
    const int code = written_when_ready(descriptor.get(), part, calls);
    if (code != 0) return failure(file, "written", code);
  }
  if (!descriptor.close() && errno != EINTR) return failure(file, "written", errno);
  return {};
}

Result<void> write_beside(const fs::path& file, const Parts& parts, Durability durability,
                          const SystemCalls& calls) {
  const auto folder = Folder::open(file.parent_path(), calls);
  if (!folder) {
    return Error{folder.error().code,
                 shown(file) + ": cannot be written: " + folder.error().message};
  }
  const auto name = file.filename().string();
  if (name.empty() || name == "." || name == "..") return failure(file, "written", EISDIR);
  const auto before = folder->status(name);
  if (!before) return before.error();

  auto temporary = TemporaryFile::create(*folder, TemporaryKind::kSingle, name);
  if (!temporary) return temporary.error();
  if (*before && S_ISREG((*before)->st_mode)) {
    const mode_t mode = (*before)->st_mode & kPermissions;
    const int kept = uninterrupted([&] { return calls.fchmod(temporary->descriptor(), mode); });
    if (kept != 0) return failure(file, "given its mode", errno);
  }
  for (const auto part : parts) {
    if (auto done = temporary->write(part); !done) return done;
  }
  if (auto done = temporary->finish(durability); !done) return done;
  if (auto done = temporary->take_place(); !done) return done;
  sweep(*folder, TemporaryKind::kSingle);
  return folder->sync(durability);
}

}  // namespace

Result<void> write_file(const fs::path& file, const Parts& parts, Durability durability,
                        const SystemCalls& calls) {
  struct stat there {};
  const bool exists = status_of(file, there, 0, calls) == 0;
  if (!exists && errno != ENOENT) return failure(file, "written", errno);
  if (exists && S_ISDIR(there.st_mode)) return failure(file, "written", EISDIR);
  if (exists && !S_ISREG(there.st_mode)) return write_through(file, 0, parts, calls);
  if (exists && is_our_output(there, calls)) return write_through(file, O_APPEND, parts, calls);

  const auto place = followed(file, calls);
  if (!place) return place.error();
  if (struct stat found{};
      exists && (status_of(*place, found, 0, calls) != 0 || !is_same(found, there))) {
    return write_through(file, O_TRUNC, parts, calls);  // a file that has no name any more
  }
  return write_beside(*place, parts, durability, calls);
}

Result<void> write_file(const fs::path& file, std::string_view text, Durability durability,
                        const SystemCalls& calls) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return write_file(file, Parts{{bytes, text.size()}}, durability, calls);
}

}  // namespace flowdlo::files
