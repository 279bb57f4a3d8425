// DeviceNode: a device of the test's own, for what must not happen to the machine's.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>

namespace flowdlo::test {

constexpr unsigned kNull = 3;  ///< the minor number of what takes everything
constexpr unsigned kFull = 7;  ///< and of what takes nothing

/// False where this user, or this file system, has no devices.
inline bool make_device(const std::filesystem::path& file, unsigned number) {
  if (::mknod(file.c_str(), S_IFCHR | 0600, makedev(1, number)) != 0) return false;
  const int opened = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (opened >= 0) ::close(opened);
  return opened >= 0;
}

}  // namespace flowdlo::test
