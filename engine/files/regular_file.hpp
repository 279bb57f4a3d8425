// RegularFile: a file that is opened without waiting and read within a bound.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "files/descriptor.hpp"
#include "files/regular_size.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::files {

/// Memory that was not set to zero before it was read into; aligned for every scalar type.
struct FileBytes {
  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> view() const { return {data.get(), size}; }
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(data.get()), size};
  }
};

class RegularFile {
 public:
  /// Opens `name` in the open folder `folder` (AT_FDCWD: the process's own), following links unless
  /// `flags` holds O_NOFOLLOW. A pipe, a device or a folder is refused, never waited for. Fails
  /// with kIo; `shown_as` stands in messages.
  [[nodiscard]] static Result<RegularFile> open(int folder, const char* name,
                                                std::filesystem::path shown_as,
                                                const SystemCalls& calls = kernel(), int flags = 0);

  /// `file` by its path.
  [[nodiscard]] static Result<RegularFile> open(const std::filesystem::path& file,
                                                const SystemCalls& calls = kernel());

  [[nodiscard]] std::uint64_t size() const { return static_cast<std::uint64_t>(status_.st_size); }
  [[nodiscard]] const struct stat& status() const { return status_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// The whole file, as long as it was when it was opened. Fails with kBadInput when that is more
  /// than `max_bytes`, and with kIo when it cannot be read, or grows or shrinks meanwhile.
  [[nodiscard]] Result<FileBytes> read(std::uint64_t max_bytes) const;

 private:
  RegularFile(Descriptor descriptor, const struct stat& status, std::filesystem::path path,
              const SystemCalls& calls)
      : descriptor_(std::move(descriptor)),
        status_(status),
        path_(std::move(path)),
        calls_(&calls) {}

  Descriptor descriptor_;
  struct stat status_ {};
  std::filesystem::path path_;
  const SystemCalls* calls_;
};

/// RegularFile::open() and read() at once.
[[nodiscard]] Result<FileBytes> read_file(const std::filesystem::path& file,
                                          std::uint64_t max_bytes,
                                          const SystemCalls& calls = kernel());

/// As text.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& file,
                                            std::uint64_t max_bytes,
                                            const SystemCalls& calls = kernel());

}  // namespace flowdlo::files
