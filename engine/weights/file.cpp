#include "weights/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace flowdlo::weights {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }

  [[nodiscard]] int get() const { return value_; }
  [[nodiscard]] bool close() { return ::close(std::exchange(value_, -1)) == 0; }

 private:
  int value_;
};

std::string reason(int code) { return std::generic_category().message(code); }

Error unreadable(const std::filesystem::path& file, const std::string& got) {
  return {ErrorCode::kIo,
          fmt::format("{}: expected a readable file, got: {}; check the path", file.string(), got)};
}

Error unwritable(const std::filesystem::path& file, int code) {
  return {ErrorCode::kIo, fmt::format("{}: expected a writable place, got: {}; check the folder",
                                      file.string(), reason(code))};
}

/// Zero, or the errno of what failed.
int write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

/// A new file beside `file` under a name that nobody holds; its name is left in `name`.
int open_temporary(const std::filesystem::path& file, std::filesystem::path& name) {
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    name = file.parent_path() / fmt::format(".flowdlo-{}-{}.tmp", ::getpid(), attempt);
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

}  // namespace

Result<FileBytes> read_file(const std::filesystem::path& file) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (descriptor.get() < 0 || ::fstat(descriptor.get(), &status) != 0) {
    return unreadable(file, reason(errno));
  }
  if (S_ISDIR(status.st_mode)) return unreadable(file, "a folder");
  if (!S_ISREG(status.st_mode)) return unreadable(file, "no regular file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > kLargestFile) {
    return bad_weights(
        file, {fmt::format("expected at most {} bytes, got {}; give a FlowDLO weights file",
                           kLargestFile, size)});
  }
  FileBytes bytes{std::make_unique_for_overwrite<std::uint8_t[]>(size), size};
  for (std::size_t filled = 0; filled < size;) {
    const ssize_t count = ::read(descriptor.get(), bytes.data.get() + filled, size - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable(file, reason(errno));
    if (count == 0) return unreadable(file, "a file that shrinks while it is read");
    filled += static_cast<std::size_t>(count);
  }
  return bytes;
}

Result<void> write_file(const std::filesystem::path& file,
                        const std::vector<std::span<const std::uint8_t>>& parts) {
  std::filesystem::path temporary;
  Descriptor descriptor{open_temporary(file, temporary)};
  if (descriptor.get() < 0) return unwritable(file, errno);
  int code = 0;
  for (const auto part : parts) {
    if (code == 0) code = write_all(descriptor.get(), part);
  }
  if (!descriptor.close() && code == 0) code = errno;
  if (code == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) code = errno;
  if (code == 0) return {};
  ::unlink(temporary.c_str());
  return unwritable(file, code);
}

Error bad_weights(const std::filesystem::path& file, const std::vector<std::string>& faults) {
  std::string message;
  for (const std::string& fault : faults) {
    message += fmt::format("{}{}: {}", message.empty() ? "" : "\n", file.string(), fault);
  }
  return {ErrorCode::kBadWeights, message};
}

}  // namespace flowdlo::weights
