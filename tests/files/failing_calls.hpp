// FailingCalls: the system's calls, one of which fails, or after which nothing more is done.
#pragma once

#include <array>
#include <cerrno>
#include <climits>
#include <ostream>

#include "files/system_calls.hpp"

namespace flowdlo::test {

/// What happens at one call, and after it.
struct Fault {
  enum class Kind {
    kOnce,     ///< that call fails, the later ones do not
    kForGood,  ///< that call and all later ones fail
    kKilled,   ///< that call and all later ones are not made: the process has ended
    kShort,    ///< every write from then on takes one byte
  };
  Kind kind = Kind::kOnce;
  int code = EIO;    ///< the errno
  int at = INT_MAX;  ///< which call, from 0
};

std::ostream& operator<<(std::ostream& stream, const Fault& fault);

/// Every way in which one call can go wrong.
[[nodiscard]] const std::vector<Fault>& faults_of_a_call();

/// Counts each call that can fail, and fails as told. Nothing waits for the disk.
class FailingCalls : public files::SystemCalls {
 public:
  FailingCalls() = default;
  explicit FailingCalls(const Fault& fault) : fault_(fault) {}

  [[nodiscard]] int count() const { return count_; }

  /// Locks as NFS does: no folders.
  void without_folder_locks() { folder_locks_ = false; }

  int openat(int folder, const char* name, int flags, mode_t mode) const override;
  int mkdirat(int folder, const char* name, mode_t mode) const override;
  int fstat(int file, struct stat& status) const override;
  int fstatat(int folder, const char* name, struct stat& status, int flags) const override;
  ssize_t readlinkat(int folder, const char* name, char* target, std::size_t size) const override;
  ssize_t read(int file, void* bytes, std::size_t size) const override;
  ssize_t write(int file, const void* bytes, std::size_t size) const override;
  int fsync(int file) const override;
  int fchmod(int file, mode_t mode) const override;
  int flock(int file, int operation) const override;
  int renameat(int folder, const char* from, const char* to) const override;
  int unlinkat(int folder, const char* name) const override;
  int close(int file) const override;
  int list(int folder, std::vector<std::string>& names) const override;
  int random(std::uint64_t& bits) const override;
  void sleep_ms(int milliseconds) const override;

 private:
  /// Whether the call to come fails; errno is set then.
  [[nodiscard]] bool fails() const;

  Fault fault_;
  bool folder_locks_ = true;
  mutable int count_ = 0;
};

}  // namespace flowdlo::test
