// CacheFolder: where compiled kernels, and which of them a device got, are kept between processes.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace flowdlo::estimator {

/// FLOWDLO_CACHE, a folder, or `off` for none; otherwise flowdlo below XDG's cache folder. Empty:
/// nothing is kept. Only absolute paths count. `variable` gives the environment's variables.
template <class Variable>
[[nodiscard]] std::filesystem::path cache_folder(const Variable& variable) {
  const auto absolute = [](const char* folder) { return folder != nullptr && folder[0] == '/'; };
  if (const char* const own = variable("FLOWDLO_CACHE"); own != nullptr && own[0] != '\0') {
    return absolute(own) ? std::filesystem::path(own) : std::filesystem::path();
  }
  if (const char* const caches = variable("XDG_CACHE_HOME"); absolute(caches)) {
    return std::filesystem::path(caches) / "flowdlo";
  }
  if (const char* const home = variable("HOME"); absolute(home)) {
    return std::filesystem::path(home) / ".cache/flowdlo";
  }
  return {};
}

}  // namespace flowdlo::estimator
