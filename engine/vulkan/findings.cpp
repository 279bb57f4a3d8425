#include "vulkan/findings.hpp"

#include <map>
#include <mutex>
#include <string>

#include "vulkan/device.hpp"
#include "vulkan/stored_file.hpp"

namespace flowdlo::vulkan {
namespace {

struct Own {
  std::mutex mutex;
  std::map<std::string, std::vector<char>> findings;  // by the file that would hold them
};

/// Never destroyed: a thread that comes back to a device may outlive what the process ends with.
Own& own() {
  static Own* const memory = new Own();
  return *memory;
}

std::string place_of(const Device& device, const std::filesystem::path& folder,
                     std::string_view kind) {
  return (folder / stored_name(device, kind)).string();
}

}  // namespace

std::vector<char> known(const Device& device, const std::filesystem::path& folder,
                        std::string_view kind) {
  const std::lock_guard lock(own().mutex);
  const std::string place = place_of(device, folder, kind);
  const auto found = own().findings.find(place);
  if (found != own().findings.end()) return found->second;
  if (folder.empty()) return {};
  std::vector<char> stored = read_stored(device, folder, kind);
  if (!stored.empty()) own().findings.emplace(place, stored);
  return stored;
}

std::vector<char> settle(const Device& device, const std::filesystem::path& folder,
                         std::string_view kind, const std::vector<char>& found) {
  const std::lock_guard lock(own().mutex);
  const auto [kept, first] = own().findings.emplace(place_of(device, folder, kind), found);
  if (first && !folder.empty()) write_stored(device, folder, kind, found);
  return kept->second;
}

void forget_findings() {
  const std::lock_guard lock(own().mutex);
  own().findings.clear();
}

}  // namespace flowdlo::vulkan
