#include "vulkan/descriptors.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flowdlo::vulkan {
namespace {

std::string key_of(const Binding& binding) {
  return fmt::format("{}:{}:{}:{}", static_cast<int>(binding.kind), binding.range.resource,
                     binding.range.offset, binding.range.size);
}

std::string key_of(const Dispatch& dispatch) {
  std::string key = fmt::format("{}", dispatch.kernel);
  for (const Binding& binding : dispatch.bindings) key.append(" ").append(key_of(binding));
  return key;
}

VkFormat format_of(BindingKind kind) {
  switch (kind) {
    case BindingKind::kTexels:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case BindingKind::kWords:
      return VK_FORMAT_R32G32B32A32_UINT;
    default:
      return VK_FORMAT_R32_SFLOAT;
  }
}

}  // namespace

Result<VkBufferView> Descriptors::view_of(const Device& device, const Plan& plan,
                                          const Binding& binding) {
  const std::string key = key_of(binding);
  if (const auto known = views_.find(key); known != views_.end()) return known->second.get();
  const Resources::Place place = plan.resources().place(binding.range);
  const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                    .pNext = nullptr,
                                    .flags = 0,
                                    .buffer = place.buffer,
                                    .format = format_of(binding.kind),
                                    .offset = place.offset,
                                    .range = binding.range.size};
  auto view =
      device.create(device.api().vkCreateBufferView, device.api().vkDestroyBufferView, info,
                    VK_OBJECT_TYPE_BUFFER_VIEW, plan.resources().name(binding.range.resource));
  if (!view) return view.error();
  return views_.emplace(key, *std::move(view)).first->second.get();
}

Result<void> Descriptors::create_pool(const Device& device,
                                      const std::vector<const Dispatch*>& distinct) {
  std::uint32_t texel_buffers = 0;
  std::uint32_t storage_buffers = 0;
  for (const Dispatch* dispatch : distinct) {
    for (const Binding& binding : dispatch->bindings) {
      ++(binding.kind == BindingKind::kStorage ? storage_buffers : texel_buffers);
    }
  }
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, std::max(texel_buffers, 1U)},
       {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(storage_buffers, 1U)}}};
  const VkDescriptorPoolCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
      .pNext = nullptr,
      .flags = 0,
      .maxSets = std::max(static_cast<std::uint32_t>(distinct.size()), 1U),
      .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
      .pPoolSizes = sizes.data()};
  auto pool =
      device.create(device.api().vkCreateDescriptorPool, device.api().vkDestroyDescriptorPool, info,
                    VK_OBJECT_TYPE_DESCRIPTOR_POOL, "program");
  if (!pool) return pool.error();
  pool_ = *std::move(pool);
  return {};
}

Result<VkDescriptorSet> Descriptors::create_set(const Device& device, const Plan& plan,
                                                const Dispatch& dispatch, const Kernel& kernel) {
  const VkDescriptorSetLayout layout = kernel.set_layout();
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .pNext = nullptr,
                                         .descriptorPool = pool_.get(),
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  const std::string name = plan.kernels()[dispatch.kernel].name();
  VkDescriptorSet set = VK_NULL_HANDLE;
  const auto allocated =
      device.check(device.api().vkAllocateDescriptorSets(device.handle(), &info, &set),
                   fmt::format("vkAllocateDescriptorSets({})", name));
  if (!allocated) return allocated.error();
  device.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, name);

  const std::size_t count = dispatch.bindings.size();
  std::vector<VkDescriptorBufferInfo> buffers(count);
  std::vector<VkBufferView> views(count);
  std::vector<VkWriteDescriptorSet> writes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Binding& binding = dispatch.bindings[i];
    const bool is_storage = binding.kind == BindingKind::kStorage;
    if (is_storage) {
      const Resources::Place place = plan.resources().place(binding.range);
      buffers[i] = {place.buffer, place.offset, binding.range.size};
    } else {
      const auto view = view_of(device, plan, binding);
      if (!view) return view.error();
      views[i] = *view;
    }
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .pNext = nullptr,
                 .dstSet = set,
                 .dstBinding = static_cast<std::uint32_t>(i),
                 .dstArrayElement = 0,
                 .descriptorCount = 1,
                 .descriptorType = is_storage ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                              : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                 .pImageInfo = nullptr,
                 .pBufferInfo = is_storage ? &buffers[i] : nullptr,
                 .pTexelBufferView = is_storage ? nullptr : &views[i]};
  }
  device.api().vkUpdateDescriptorSets(device.handle(), static_cast<std::uint32_t>(count),
                                      writes.data(), 0, nullptr);
  return set;
}

Result<Descriptors> Descriptors::create(const Device& device, const Plan& plan,
                                        const std::vector<const Kernel*>& kernels) {
  std::map<std::string, std::size_t> index;  // of each distinct set
  std::vector<const Dispatch*> distinct;
  std::vector<std::size_t> uses;
  for (const Step& step : plan.steps()) {
    const auto* dispatch = std::get_if<Dispatch>(&step);
    if (dispatch == nullptr) continue;
    const auto [entry, is_new] = index.try_emplace(key_of(*dispatch), distinct.size());
    if (is_new) distinct.push_back(dispatch);
    uses.push_back(entry->second);
  }
  Descriptors descriptors;
  const auto pooled = descriptors.create_pool(device, distinct);
  if (!pooled) return pooled.error();
  std::vector<VkDescriptorSet> sets;
  for (const Dispatch* dispatch : distinct) {
    const auto set = descriptors.create_set(device, plan, *dispatch, *kernels[dispatch->kernel]);
    if (!set) return set.error();
    sets.push_back(*set);
  }
  for (const std::size_t use : uses) descriptors.sets_.push_back(sets[use]);
  return descriptors;
}

}  // namespace flowdlo::vulkan
