#include "weights/location.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <system_error>

#include "files/own_file.hpp"
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
  const std::array way = {folder, share, ours, ours / "flowdlo.fdw"};
  return std::any_of(way.begin(), way.end(), files::anybody_writes);
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
    for (const fs::path& folder : files::folders_around(program)) {
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
  const fs::path program = files::running_program();
  // A program with more rights than its caller does not take the caller's word for its weights.
  return default_location(
      {::secure_getenv(kVariable), embedded(), {files::own_file(program), program}});
}

}  // namespace flowdlo::weights
