// SystemCalls: what the library asks of the kernel about files, call by call, so that a test can
// have any one of them fail.
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flowdlo::files {

/// Each call is that of its name in the manual's section 2: -1 and errno where it fails.
class SystemCalls {
 public:
  SystemCalls() = default;
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;
  virtual ~SystemCalls() = default;

  virtual int openat(int folder, const char* name, int flags, mode_t mode) const;
  virtual int mkdirat(int folder, const char* name, mode_t mode) const;
  virtual int fstat(int file, struct stat& status) const;
  virtual int fstatat(int folder, const char* name, struct stat& status, int flags) const;
  virtual ssize_t readlinkat(int folder, const char* name, char* target, std::size_t size) const;
  virtual ssize_t read(int file, void* bytes, std::size_t size) const;
  virtual ssize_t write(int file, const void* bytes, std::size_t size) const;
  virtual int fsync(int file) const;
  virtual int fchmod(int file, mode_t mode) const;
  virtual int flock(int file, int operation) const;
  virtual int renameat(int folder, const char* from, const char* to) const;  ///< in one folder
  virtual int unlinkat(int folder, const char* name) const;
  virtual int close(int file) const;

  /// The names in a folder, in no order, without "." and "..".
  virtual int list(int folder, std::vector<std::string>& names) const;

  /// 64 bits that nobody can guess.
  virtual int random(std::uint64_t& bits) const;

  /// Waits until `file` can be written, for at most `milliseconds`: 1, or 0 when it still cannot.
  virtual int await_writable(int file, int milliseconds) const;

  virtual void sleep_ms(int milliseconds) const;
  [[nodiscard]] virtual std::int64_t now_s() const;  ///< as files' times count: since 1970
};

/// The system's own.
[[nodiscard]] const SystemCalls& kernel();

}  // namespace flowdlo::files
