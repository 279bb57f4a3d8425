#include "estimator/weights_location.hpp"

#include <dlfcn.h>

#include <string>
#include <system_error>

namespace flowdlo::estimator {
namespace {

/// The file that this function was loaded from: the shared library, or the program.
std::filesystem::path own_file() {
  Dl_info info{};
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) {
    return program;
  }
  const auto file = std::filesystem::canonical(info.dli_fname, error);
  return error ? program : file;  // a program's dli_fname may be relative to a past directory
}

}  // namespace

Result<std::filesystem::path> default_weights() {
  constexpr int kLevels = 3;  // lib/, lib/<triplet>/, bin/
  std::string looked;
  std::filesystem::path folder = own_file().parent_path();
  for (int level = 0; level < kLevels && folder.has_relative_path(); ++level) {
    folder = folder.parent_path();
    const auto candidate = folder / "share" / "flowdlo" / "flowdlo.fdw";
    std::error_code error;
    if (std::filesystem::is_regular_file(candidate, error)) return candidate;
    looked += (looked.empty() ? "" : ", ") + candidate.string();
  }
  return Error{
      ErrorCode::kBadWeights,
      "Config.weights: expected a .fdw file, got none, and none is installed (looked for " +
          looked + "); name one"};
}

std::filesystem::path field_beside(const std::filesystem::path& weights) {
  const auto file = weights.parent_path() / "field.safetensors";
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) ? file : std::filesystem::path();
}

}  // namespace flowdlo::estimator
