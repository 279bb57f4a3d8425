#include "files/failing_calls.hpp"

namespace flowdlo::test {

using files::SystemCalls;

std::ostream& operator<<(std::ostream& stream, const Fault& fault) {
  static constexpr std::array kNames = {"once", "for good", "killed", "short writes"};
  return stream << kNames[static_cast<std::size_t>(fault.kind)] << ", errno " << fault.code
                << ", at call " << fault.at;
}

const std::vector<Fault>& faults_of_a_call() {
  static const std::vector<Fault> faults = {
      {Fault::Kind::kKilled, EIO, 0},     {Fault::Kind::kOnce, EIO, 0},
      {Fault::Kind::kForGood, EIO, 0},    {Fault::Kind::kOnce, ENOSPC, 0},
      {Fault::Kind::kForGood, ENOSPC, 0}, {Fault::Kind::kOnce, EINTR, 0},
      {Fault::Kind::kForGood, EMFILE, 0}, {Fault::Kind::kForGood, EROFS, 0},
      {Fault::Kind::kOnce, EACCES, 0},    {Fault::Kind::kShort, 0, 0}};
  return faults;
}

bool FailingCalls::fails() const {
  const int index = count_++;
  const bool hit = fault_.kind == Fault::Kind::kOnce ? index == fault_.at : index >= fault_.at;
  if (!hit || fault_.kind == Fault::Kind::kShort) return false;
  errno = fault_.code;
  return true;
}

int FailingCalls::openat(int folder, const char* name, int flags, mode_t mode) const {
  return fails() ? -1 : SystemCalls::openat(folder, name, flags, mode);
}

int FailingCalls::mkdirat(int folder, const char* name, mode_t mode) const {
  return fails() ? -1 : SystemCalls::mkdirat(folder, name, mode);
}

int FailingCalls::fstat(int file, struct stat& status) const {
  return fails() ? -1 : SystemCalls::fstat(file, status);
}

int FailingCalls::fstatat(int folder, const char* name, struct stat& status, int flags) const {
  return fails() ? -1 : SystemCalls::fstatat(folder, name, status, flags);
}

ssize_t FailingCalls::readlinkat(int folder, const char* name, char* target,
                                 std::size_t size) const {
  return fails() ? -1 : SystemCalls::readlinkat(folder, name, target, size);
}

ssize_t FailingCalls::read(int file, void* bytes, std::size_t size) const {
  return fails() ? -1 : SystemCalls::read(file, bytes, size);
}

ssize_t FailingCalls::write(int file, const void* bytes, std::size_t size) const {
  if (fails()) return -1;
  const bool is_short = fault_.kind == Fault::Kind::kShort && count_ > fault_.at && size > 0;
  return SystemCalls::write(file, bytes, is_short ? 1 : size);
}

int FailingCalls::fsync(int) const { return fails() ? -1 : 0; }

int FailingCalls::fchmod(int file, mode_t mode) const {
  return fails() ? -1 : SystemCalls::fchmod(file, mode);
}

int FailingCalls::flock(int file, int operation) const {
  if (fails()) return -1;
  struct stat status {};
  if (!folder_locks_ && SystemCalls::fstat(file, status) == 0 && S_ISDIR(status.st_mode)) {
    errno = EBADF;
    return -1;
  }
  return SystemCalls::flock(file, operation);
}

int FailingCalls::renameat(int folder, const char* from, const char* to) const {
  return fails() ? -1 : SystemCalls::renameat(folder, from, to);
}

int FailingCalls::unlinkat(int folder, const char* name) const {
  return fails() ? -1 : SystemCalls::unlinkat(folder, name);
}

// Closed in any case, as the system does it, and as the end of a process would.
int FailingCalls::close(int file) const {
  const bool failed = fails();
  const int code = errno;
  const int closed = SystemCalls::close(file);
  errno = failed ? code : errno;
  return failed ? -1 : closed;
}

int FailingCalls::list(int folder, std::vector<std::string>& names) const {
  return fails() ? -1 : SystemCalls::list(folder, names);
}

int FailingCalls::random(std::uint64_t& bits) const {
  return fails() ? -1 : SystemCalls::random(bits);
}

void FailingCalls::sleep_ms(int) const {}

}  // namespace flowdlo::test
