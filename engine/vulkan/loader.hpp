// Loader: the system's Vulkan loader, opened at run time; nothing links to it. Or one driver in its
// place, where the loader would bring in others as well.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "flowdlo/result.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

class Loader {
 public:
  /// Fails with kNoDevice where there is no loader, or one older than Vulkan 1.1.
  [[nodiscard]] static Result<std::shared_ptr<const Loader>> open();

  /// One driver without the loader, and so without layers. `library`: as dlopen() takes it. Fails
  /// with kNoDevice where it is none, or one that only loaders of 2016 know.
  [[nodiscard]] static Result<std::shared_ptr<const Loader>> open_driver(
      const std::string& library);

  /// The host's, who keeps it loaded.
  [[nodiscard]] static std::shared_ptr<const Loader> of_host(PFN_vkGetInstanceProcAddr get);

  [[nodiscard]] PFN_vkVoidFunction find(VkInstance instance, const char* name) const {
    return get_instance_proc_addr_(instance, name);
  }
  /// "1.3.239"; of a driver: empty
  [[nodiscard]] const std::string& version() const { return version_; }

  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;
  ~Loader();

 private:
  Loader(void* library, PFN_vkGetInstanceProcAddr get)
      : library_(library), get_instance_proc_addr_(get) {}

  void* library_;  // null: the host's
  PFN_vkGetInstanceProcAddr get_instance_proc_addr_;
  std::string version_;
};

/// "1.3.239" of a packed version.
[[nodiscard]] std::string version_text(std::uint32_t packed);

}  // namespace flowdlo::vulkan
