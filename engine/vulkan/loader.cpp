#include "vulkan/loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "files/shown_name.hpp"
#include "vulkan/absence.hpp"

namespace flowdlo::vulkan {
namespace {

/// Of the interface between loaders and drivers: every version of the API is understood.
constexpr std::uint32_t kDriverInterface = 5;
using PFN_vkNegotiateLoaderICDInterfaceVersion = VkResult(VKAPI_PTR*)(std::uint32_t* version);

}  // namespace

std::string version_text(std::uint32_t packed) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(packed), VK_API_VERSION_MINOR(packed),
                     VK_API_VERSION_PATCH(packed));
}

Loader::~Loader() {
  if (library_ != nullptr) dlclose(library_);
}

std::shared_ptr<const Loader> Loader::of_host(PFN_vkGetInstanceProcAddr get) {
  return std::shared_ptr<const Loader>(new Loader(nullptr, get));
}

Result<std::shared_ptr<const Loader>> Loader::open() {
  void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const reason = dlerror();
    return no_loader(reason != nullptr ? reason : "none");
  }
  const auto get =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
  if (get == nullptr) {
    dlclose(library);
    return no_loader("one without vkGetInstanceProcAddr");
  }
  std::shared_ptr<Loader> loader(new Loader(library, get));
  const auto version_of = reinterpret_cast<PFN_vkEnumerateInstanceVersion>(
      loader->find(VK_NULL_HANDLE, "vkEnumerateInstanceVersion"));
  std::uint32_t version = VK_API_VERSION_1_0;
  if (version_of != nullptr) version_of(&version);
  loader->version_ = version_text(version);
  if (version < VK_API_VERSION_1_1) {
    return Error{ErrorCode::kNoDevice,
                 fmt::format("Vulkan loader: expected version 1.1, got {}; update libvulkan1",
                             loader->version_)};
  }
  return std::shared_ptr<const Loader>(std::move(loader));
}

Result<std::shared_ptr<const Loader>> Loader::open_driver(const std::string& library_name) {
  const auto refused = [&](const char* got) {
    return Error{ErrorCode::kNoDevice,
                 fmt::format("Vulkan driver {}: expected one that takes the loader's interface, "
                             "got {}; update it",
                             files::shown(std::string_view(library_name)), got)};
  };
  void* library = dlopen(library_name.c_str(), RTLD_LAZY | RTLD_LOCAL);  // as the loader does
  if (library == nullptr) {
    const char* const reason = dlerror();
    return refused(reason != nullptr ? reason : "none");
  }
  const auto negotiate = reinterpret_cast<PFN_vkNegotiateLoaderICDInterfaceVersion>(
      dlsym(library, "vk_icdNegotiateLoaderICDInterfaceVersion"));
  const auto get =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vk_icdGetInstanceProcAddr"));
  std::uint32_t interface = kDriverInterface;
  if (get == nullptr || (negotiate != nullptr && negotiate(&interface) != VK_SUCCESS)) {
    dlclose(library);
    return refused("one that does not");
  }
  return std::shared_ptr<const Loader>(new Loader(library, get));
}

}  // namespace flowdlo::vulkan
