#include "files/system_calls.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace flowdlo::files {

int SystemCalls::openat(int folder, const char* name, int flags, mode_t mode) const {
  return ::openat(folder, name, flags, mode);
}

int SystemCalls::mkdirat(int folder, const char* name, mode_t mode) const {
  return ::mkdirat(folder, name, mode);
}

int SystemCalls::fstat(int file, struct stat& status) const { return ::fstat(file, &status); }

int SystemCalls::fstatat(int folder, const char* name, struct stat& status, int flags) const {
  return ::fstatat(folder, name, &status, flags);
}

ssize_t SystemCalls::readlinkat(int folder, const char* name, char* target,
                                std::size_t size) const {
  return ::readlinkat(folder, name, target, size);
}

ssize_t SystemCalls::read(int file, void* bytes, std::size_t size) const {
  return ::read(file, bytes, size);
}

ssize_t SystemCalls::write(int file, const void* bytes, std::size_t size) const {
  return ::write(file, bytes, size);
}

int SystemCalls::fsync(int file) const { return ::fsync(file); }

int SystemCalls::fchmod(int file, mode_t mode) const { return ::fchmod(file, mode); }

int SystemCalls::flock(int file, int operation) const { return ::flock(file, operation); }

int SystemCalls::renameat(int folder, const char* from, const char* to) const {
  return ::renameat(folder, from, folder, to);
}

int SystemCalls::unlinkat(int folder, const char* name) const {
  return ::unlinkat(folder, name, 0);
}

int SystemCalls::close(int file) const { return ::close(file); }

int SystemCalls::list(int folder, std::vector<std::string>& names) const {
  const int own = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (own < 0) return -1;
  DIR* stream = ::fdopendir(own);  // takes `own`, whose place in the folder is its own too
  if (stream == nullptr) {
    const int code = errno;
    ::close(own);
    errno = code;
    return -1;
  }
  errno = 0;
  while (const dirent* entry = ::readdir(stream)) {
    if (std::strcmp(entry->d_name, ".") != 0 && std::strcmp(entry->d_name, "..") != 0) {
      names.emplace_back(entry->d_name);
    }
  }
  const int code = errno;
  ::closedir(stream);
  errno = code;
  return code == 0 ? 0 : -1;
}

int SystemCalls::random(std::uint64_t& bits) const {
  const auto got = ::getrandom(&bits, sizeof(bits), 0);
  if (got == static_cast<ssize_t>(sizeof(bits))) return 0;
  if (got >= 0) errno = EINTR;
  return -1;
}

int SystemCalls::await_writable(int file, int milliseconds) const {
  pollfd one{file, POLLOUT, 0};
  return ::poll(&one, 1, milliseconds);
}

void SystemCalls::sleep_ms(int milliseconds) const {
  const timespec time{milliseconds / 1000, (milliseconds % 1000) * 1000000L};
  ::nanosleep(&time, nullptr);
}

std::int64_t SystemCalls::now_s() const { return ::time(nullptr); }

const SystemCalls& kernel() {
  static const SystemCalls calls;
  return calls;
}

}  // namespace flowdlo::files
