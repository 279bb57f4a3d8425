#include "weights/location.hpp"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <system_error>

#include "files/shown_name.hpp"

namespace flowdlo::weights {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

/// Somebody else may have laid it there. What lies above `folder` is not asked: whoever writes
/// there may replace the program as well.
bool anybody_writes(const fs::path& folder) {
  const fs::path share = folder / "share";
  const fs::path ours = share / "flowdlo";
  for (const fs::path& path : {folder, share, ours, ours / "flowdlo.fdw"}) {
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0 && (status.st_mode & S_IWOTH) != 0) return true;
  }
  return false;
}

/// The program's folder and three above it, for programs in bin/, lib/ and lib/<triplet>/.
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

/// The file that this function was loaded from: the shared library, or the program.
fs::path own_file(const fs::path& program) {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) {
    return program;
  }
  std::error_code error;
  auto file = fs::canonical(info.dli_fname, error);
  return error ? program : file;  // a program's dli_fname may be relative to a past directory
}

}  // namespace

Location located(const fs::path& model) {
  const auto field = model.parent_path() / "field.safetensors";
  return {{model, {}}, {is_file(field) ? field : fs::path(), {}}};
}

Result<Location> default_location(const Surroundings& surroundings) {
  if (surroundings.named != nullptr && *surroundings.named != '\0') {
    const fs::path file = surroundings.named;
    if (is_file(file)) return located(file);
    return Error{ErrorCode::kBadWeights,
                 std::string(kVariable) + " in the environment: expected a .fdw file, got " +
                     files::shown(file) + ", which is none; correct it or unset it"};
  }
  const Embedded& embedded = surroundings.embedded;
  if (!embedded.model.empty()) {
    return Location{{"the library's own flowdlo.fdw", embedded.model},
                    {"the library's own field.safetensors", embedded.field}};
  }
  std::vector<fs::path> seen;
  std::string looked;
  for (const fs::path& program : surroundings.programs) {
    for (const fs::path& folder : folders_around(program)) {
      if (std::find(seen.begin(), seen.end(), folder) != seen.end()) continue;
      seen.push_back(folder);
      const auto candidate = folder / "share" / "flowdlo" / "flowdlo.fdw";
      const bool unsafe = anybody_writes(folder);
      if (!unsafe && is_file(candidate)) return located(candidate);
      looked += (looked.empty() ? "" : ", ") + files::shown(candidate) +
                (unsafe ? " (not taken: anybody may write there)" : "");
    }
  }
  return Error{
      ErrorCode::kBadWeights,
      "Config.weights: expected a .fdw file, got none, and none is installed (looked for " +
          looked + "); name one, here or by " + kVariable + " in the environment"};
}

Result<Location> default_location() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  // A program with more rights than its caller does not take the caller's word for its weights.
  return default_location({::secure_getenv(kVariable), embedded(), {own_file(program), program}});
}

}  // namespace flowdlo::weights
