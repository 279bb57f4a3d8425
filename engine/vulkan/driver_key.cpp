#include "vulkan/driver_key.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "vulkan/driver_manifests.hpp"

extern char** environ;  // NOLINT: POSIX names it so

namespace flowdlo::vulkan {
namespace {

namespace fs = std::filesystem;

/// Beginnings of the names of variables by which drivers, and what they load, are told what to do.
constexpr std::array<std::string_view, 24> kRead = {
    "ACO_",  "AMD_", "ANV_", "DRI_",  "FD_",  "GALLIUM_", "HASVK_", "INTEL_",
    "LD_",   "LP_",  "LVP_", "MESA_", "NIR_", "NVK_",     "NV_",    "PAN_",
    "RADV_", "TU_",  "V3D_", "V3DV_", "VN_",  "VK_",      "ZINK_",  "__"};
/// They say which drivers there are, and each is asked alone.
constexpr std::array<std::string_view, 3> kLists = {
    "VK_DRIVER_FILES=", "VK_ICD_FILENAMES=", "VK_ADD_DRIVER_FILES="};

/// A file's path, size and time; the path alone where there is none.
std::string of_file(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return file.string();
  return fmt::format("{} {} {}.{:09}", file.string(), status.st_size, status.st_mtim.tv_sec,
                     status.st_mtim.tv_nsec);
}

/// Where the dynamic linker finds a name on most systems; empty where not there.
fs::path found(const std::string& name) {
  std::vector<fs::path> folders;
  if (const char* const own = std::getenv("LD_LIBRARY_PATH"); own != nullptr) {
    std::string_view list = own;
    while (!list.empty()) {
      const auto end = std::min(list.find(':'), list.size());
      folders.emplace_back(list.substr(0, end));
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }
#if defined(__x86_64__)
  folders.emplace_back("/usr/lib/x86_64-linux-gnu");
#elif defined(__aarch64__)
  folders.emplace_back("/usr/lib/aarch64-linux-gnu");
#endif
  folders.insert(folders.end(), {"/usr/lib64", "/usr/lib", "/usr/local/lib"});
  std::error_code error;
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / name, error)) return folder / name;
  }
  return {};
}

/// GPUs as this process may open them.
std::string device_nodes() {
  std::vector<std::string> nodes;
  std::error_code error;
  for (fs::directory_iterator entry("/dev/dri", error), end; !error && entry != end;
       entry.increment(error)) {
    nodes.push_back(entry->path().string());
  }
  for (const char* const other : {"/dev/kfd", "/dev/nvidiactl", "/dev/dxg", "/dev/mali0"}) {
    if (fs::exists(other, error)) nodes.emplace_back(other);
  }
  std::sort(nodes.begin(), nodes.end());
  std::string text;
  for (const std::string& node : nodes) {
    text += fmt::format("{}{} ", node, ::access(node.c_str(), R_OK | W_OK) == 0 ? "" : "(closed)");
  }
  return text;
}

std::string variables() {
  std::vector<std::string_view> read;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const auto begins = [&](std::string_view with) { return variable.starts_with(with); };
    if (std::any_of(kRead.begin(), kRead.end(), begins) &&
        std::none_of(kLists.begin(), kLists.end(), begins)) {
      read.push_back(variable);
    }
  }
  std::sort(read.begin(), read.end());
  std::string text;
  for (const std::string_view variable : read) text.append(variable).append("\n");
  return text;
}

std::string kernel_release() {
  utsname names{};
  return ::uname(&names) == 0 ? fmt::format("{} {}", names.release, names.machine) : std::string();
}

}  // namespace

DriverKey driver_key(const fs::path& manifest, const std::string& loader) {
  const std::string named = driver_library(manifest);
  const fs::path library = named.find('/') == std::string::npos ? found(named) : fs::path(named);
  return {.text = fmt::format("{}\n{}\n{}\n{}\n{}\n{}", of_file(manifest),
                              library.empty() ? named : of_file(library), loader, kernel_release(),
                              device_nodes(), variables()),
          .names_library = !library.empty()};
}

}  // namespace flowdlo::vulkan
