#include "vulkan/driver_manifests.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "files/regular_file.hpp"
#include "json/parse.hpp"

namespace flowdlo::vulkan {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostManifests = 64;             // more are no driver's doing
constexpr std::uint64_t kLargestManifest = 1U << 20U;  // bytes

bool is_set(const char* value) { return value != nullptr && *value != '\0'; }

/// The parts between colons, without empty ones.
std::vector<fs::path> parts(std::string_view list) {
  std::vector<fs::path> paths;
  while (!list.empty()) {
    const auto end = std::min(list.find(':'), list.size());
    if (end > 0) paths.emplace_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return paths;
}

/// `own`, or `standard` below the home folder.
std::vector<fs::path> personal(const Variable& variable, const char* own, const char* standard) {
  if (is_set(variable(own))) return parts(variable(own));
  if (is_set(variable("HOME"))) return {fs::path(variable("HOME")) / standard};
  return {};
}

std::vector<fs::path> shared(const Variable& variable, const char* name, const char* standard) {
  return parts(is_set(variable(name)) ? variable(name) : standard);
}

/// A manifest, or every manifest of a folder.
void add(const fs::path& path, std::vector<fs::path>& manifests) {
  std::error_code error;
  std::vector<fs::path> found;
  if (fs::is_directory(path, error)) {
    for (fs::directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error)) {
      found.push_back(entry->path());
    }
    std::sort(found.begin(), found.end());
  } else {
    found.push_back(path);
  }
  for (const fs::path& file : found) {
    if (file.extension() != ".json" || manifests.size() >= kMostManifests) continue;
    fs::path whole = fs::absolute(file, error).lexically_normal();
    const bool known = std::find(manifests.begin(), manifests.end(), whole) != manifests.end();
    if (!known && fs::exists(whole, error)) manifests.push_back(std::move(whole));
  }
}

}  // namespace

std::vector<fs::path> driver_manifests(const Variable& variable) {
  std::vector<fs::path> manifests;
  for (const char* const only : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    if (!is_set(variable(only))) continue;
    for (const fs::path& path : parts(variable(only))) add(path, manifests);
    return manifests;
  }
  if (is_set(variable("VK_ADD_DRIVER_FILES"))) {
    for (const fs::path& path : parts(variable("VK_ADD_DRIVER_FILES"))) add(path, manifests);
  }
  for (const auto& folders :
       {personal(variable, "XDG_CONFIG_HOME", ".config"),
        shared(variable, "XDG_CONFIG_DIRS", "/etc/xdg"), std::vector<fs::path>{"/etc"},
        personal(variable, "XDG_DATA_HOME", ".local/share"),
        shared(variable, "XDG_DATA_DIRS", "/usr/local/share:/usr/share")}) {
    for (const fs::path& folder : folders) add(folder / "vulkan/icd.d", manifests);
  }
  return manifests;
}

std::string driver_library(const fs::path& manifest) {
  const auto text = files::read_text(manifest, kLargestManifest);
  if (!text) return {};
  const auto parsed = json::parse(*text);
  const json::Value* const driver = parsed.fine ? parsed.value.find("ICD") : nullptr;
  const json::Value* const named = driver != nullptr ? driver->find("library_path") : nullptr;
  if (named == nullptr || !named->is_string()) return {};
  const std::string& library = named->string;
  if (library.find('/') == std::string::npos) return library;
  return (manifest.parent_path() / library).lexically_normal().string();
}

}  // namespace flowdlo::vulkan
