#include "files/own_file.hpp"

#include <dlfcn.h>
#include <sys/auxv.h>
#include <sys/stat.h>

#include <system_error>

namespace flowdlo::files {

namespace fs = std::filesystem;

fs::path own_file(const fs::path& program) {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) {
    return program;
  }
  std::error_code error;
  auto file = fs::canonical(info.dli_fname, error);
  return error ? program : file;  // a program's dli_fname may be relative to a past directory
}

fs::path running_program() {
  std::error_code error;
  auto program = fs::read_symlink("/proc/self/exe", error);
  if (!error) return program;
  return program_that_began_as(reinterpret_cast<const char*>(::getauxval(AT_EXECFN)));
}

fs::path program_that_began_as(const char* name) {
  if (name == nullptr) return {};
  std::error_code error;
  auto program = fs::canonical(name, error);
  return error ? fs::path() : program;
}

std::vector<fs::path> folders_around(const fs::path& program) {
  constexpr int kAbove = 3;
  std::vector<fs::path> folders;
  fs::path folder = program.parent_path();
  for (int level = 0; level <= kAbove && folder.has_relative_path(); ++level) {
    folders.push_back(folder);
    folder = folder.parent_path();
  }
  return folders;
}

bool anybody_writes(const fs::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && (status.st_mode & S_IWOTH) != 0;
}

}  // namespace flowdlo::files
