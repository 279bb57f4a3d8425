#include "files/regular_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <string>

#include "files/failure.hpp"
#include "files/shown_name.hpp"
#include "files/uninterrupted.hpp"

namespace flowdlo::files {
namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

Error no_file(const std::filesystem::path& path, int code) {
  if (code == ENXIO) code = 0;  // a socket, or a pipe that nobody reads
  if (code == ENOENT) {
    return {ErrorCode::kIo, shown(path) + ": expected a file, found none; add it"};
  }
  if (code != 0) return failure(path, "opened", code);
  return {ErrorCode::kIo, shown(path) + ": expected a file, got a device; replace it"};
}

}  // namespace

Result<RegularFile> RegularFile::open(int folder, const char* name, std::filesystem::path shown_as,
                                      const SystemCalls& calls, int flags) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  constexpr int kFlags = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  Descriptor descriptor(
      uninterrupted([&] { return calls.openat(folder, name, kFlags | flags, 0); }), calls);
  if (!descriptor.is_open()) return no_file(shown_as, errno);
  struct stat status {};
  if (uninterrupted([&] { return calls.fstat(descriptor.get(), status); }) != 0) {
    return failure(shown_as, "looked at", errno);
  }
  if (!S_ISREG(status.st_mode)) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a file, got {}; replace it",
                                             shown(shown_as), kind_of(status.st_mode))};
  }
  return RegularFile(std::move(descriptor), status, std::move(shown_as), calls);
}

Result<RegularFile> RegularFile::open(const std::filesystem::path& file, const SystemCalls& calls) {
  return open(AT_FDCWD, file.c_str(), file, calls);
}

Result<FileBytes> RegularFile::read(std::uint64_t max_bytes) const {
  if (size() > max_bytes) {
    return Error{ErrorCode::kBadInput, fmt::format("{}: expected at most {} bytes, got {}",
                                                   shown(path_), max_bytes, size())};
  }
  const auto whole = static_cast<std::size_t>(size());
  FileBytes bytes{std::unique_ptr<std::uint8_t[]>(new std::uint8_t[whole + 1]), whole};
  std::size_t filled = 0;
  for (;;) {  // one byte more than there should be shows that it grew
    const auto count = uninterrupted([&] {
      return calls_->read(descriptor_.get(), bytes.data.get() + filled, whole + 1 - filled);
    });
    if (count < 0) return failure(path_, "read", errno);
    filled += static_cast<std::size_t>(count);
    if (count == 0 || filled > whole) break;
  }
  if (filled == whole) return bytes;
  return Error{ErrorCode::kIo,
               fmt::format("{}: expected {} bytes, got {}: it changes while it is read; read it "
                           "when its writer is done",
                           shown(path_), whole, filled > whole ? "more" : std::to_string(filled))};
}

Result<std::uint64_t> regular_size(const std::filesystem::path& file) {
  const auto opened = RegularFile::open(file);
  if (!opened) return opened.error();
  return opened->size();
}

Result<FileBytes> read_file(const std::filesystem::path& file, std::uint64_t max_bytes,
                            const SystemCalls& calls) {
  const auto opened = RegularFile::open(file, calls);
  if (!opened) return opened.error();
  return opened->read(max_bytes);
}

Result<std::string> read_text(const std::filesystem::path& file, std::uint64_t max_bytes,
                              const SystemCalls& calls) {
  const auto bytes = read_file(file, max_bytes, calls);
  if (!bytes) return bytes.error();
  return std::string(bytes->text());
}

}  // namespace flowdlo::files
