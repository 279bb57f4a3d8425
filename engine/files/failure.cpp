#include "files/failure.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "files/shown_name.hpp"

namespace flowdlo::files {
namespace {

const char* remedy(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
      return "make space on its disk";
    case EFBIG:
      return "raise the limit of a file's size";
    case EROFS:
      return "choose a folder on a disk that can be written";
    case EACCES:
    case EPERM:
      return "check the permissions of the file and of its folder";
    case EMFILE:
    case ENFILE:
      return "close files, or raise the limit of open ones (ulimit -n)";
    case ENOENT:
    case ENOTDIR:
    case ELOOP:
      return "check the path";
    case EISDIR:
      return "a folder has its place; choose another name";
    case ENAMETOOLONG:
      return "choose a shorter name";
    case EIO:
      return "check the disk";
    case EPIPE:
    case ENXIO:
      return "start its reader, and let it read to the end";
    default:
      return "check the file and its folder";
  }
}

}  // namespace

Error failure(const std::filesystem::path& file, std::string_view what, int code) {
  return {ErrorCode::kIo, fmt::format("{}: cannot be {}: {}; {}", shown(file), what,
                                      std::generic_category().message(code), remedy(code))};
}

}  // namespace flowdlo::files
