#include "vulkan/pipeline_cache.hpp"

#include "vulkan/stored_file.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr std::string_view kKind = "pipelines";

}  // namespace

void load_pipelines(const Device& device, const std::filesystem::path& folder) {
  const std::vector<char> data = read_stored(device, folder, kKind);
  if (data.empty()) return;
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .pNext = nullptr,
                                       .flags = 0,
                                       .initialDataSize = data.size(),
                                       .pInitialData = data.data()};
  const auto stored =
      device.create(device.api().vkCreatePipelineCache, device.api().vkDestroyPipelineCache, info,
                    VK_OBJECT_TYPE_PIPELINE_CACHE, "stored");
  if (!stored) return;
  const VkPipelineCache source = stored->get();
  // Failing leaves the cache as it was, which is all that is needed.
  (void)device.check(
      device.api().vkMergePipelineCaches(device.handle(), device.pipeline_cache(), 1, &source),
      "vkMergePipelineCaches");
}

void store_pipelines(const Device& device, const std::filesystem::path& folder) {
  std::size_t size = 0;
  const auto get = device.api().vkGetPipelineCacheData;
  if (get(device.handle(), device.pipeline_cache(), &size, nullptr) != VK_SUCCESS) return;
  std::vector<char> data(size);
  if (get(device.handle(), device.pipeline_cache(), &size, data.data()) != VK_SUCCESS) return;
  data.resize(size);
  if (data == read_stored(device, folder, kKind)) return;
  write_stored(device, folder, kKind, data);
}

}  // namespace flowdlo::vulkan
