#include "vulkan/kernel.hpp"

#include <fmt/format.h>

#include "vulkan/device.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr VkPipelineShaderStageCreateFlags kFullSubgroups =
    VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT_EXT;

constexpr VkPipelineCreateFlags kKeepStatistics =
    VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR |
    VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;

Result<Owned<VkDescriptorSetLayout>> create_set_layout(const Device& device,
                                                       const KernelSpec& spec) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const BindingKind kind : spec.bindings) {
    bindings.push_back({.binding = static_cast<std::uint32_t>(bindings.size()),
                        .descriptorType = kind == BindingKind::kStorage
                                              ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                              : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                        .descriptorCount = 1,
                        .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                        .pImmutableSamplers = nullptr});
  }
  const VkDescriptorSetLayoutCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
      .pNext = nullptr,
      .flags = 0,
      .bindingCount = static_cast<std::uint32_t>(bindings.size()),
      .pBindings = bindings.data()};
  return device.create(device.api().vkCreateDescriptorSetLayout,
                       device.api().vkDestroyDescriptorSetLayout, info,
                       VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, spec.name());
}

Result<Owned<VkPipelineLayout>> create_layout(const Device& device, const KernelSpec& spec,
                                              VkDescriptorSetLayout set_layout) {
  const VkPushConstantRange push{
      .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .offset = 0, .size = spec.push_bytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .pNext = nullptr,
                                        .flags = 0,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = spec.push_bytes > 0 ? 1U : 0U,
                                        .pPushConstantRanges = &push};
  return device.create(device.api().vkCreatePipelineLayout, device.api().vkDestroyPipelineLayout,
                       info, VK_OBJECT_TYPE_PIPELINE_LAYOUT, spec.name());
}

Result<Owned<VkPipeline>> create_pipeline(const Device& device, const KernelSpec& spec,
                                          VkPipelineLayout layout) {
  const bool plain = !device.facts().shuffles && !spec.shader.plain.empty();
  const auto words = plain ? spec.shader.plain : spec.shader.words;
  const VkShaderModuleCreateInfo module_info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                             .pNext = nullptr,
                                             .flags = 0,
                                             .codeSize = words.size_bytes(),
                                             .pCode = words.data()};
  const auto module =
      device.create(device.api().vkCreateShaderModule, device.api().vkDestroyShaderModule,
                    module_info, VK_OBJECT_TYPE_SHADER_MODULE, spec.shader.name);
  if (!module) return module.error();

  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < spec.constants.size(); ++i) {
    entries.push_back({.constantID = i, .offset = 4 * i, .size = 4});
  }
  const VkSpecializationInfo constants{.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
                                       .pMapEntries = entries.data(),
                                       .dataSize = spec.constants.size() * 4,
                                       .pData = spec.constants.data()};
  const VkPipelineShaderStageRequiredSubgroupSizeCreateInfoEXT required{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO_EXT,
      .pNext = nullptr,
      .requiredSubgroupSize = static_cast<std::uint32_t>(device.facts().lanes)};
  const bool fixes_lanes = spec.uses_subgroups && device.facts().fixes_lanes;
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .pNext = nullptr,
      .flags = device.facts().keeps_statistics ? kKeepStatistics : 0,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .pNext = fixes_lanes ? &required : nullptr,
                .flags = fixes_lanes && device.facts().full_subgroups ? kFullSubgroups : 0,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module->get(),
                .pName = "main",
                .pSpecializationInfo = &constants},
      .layout = layout,
      .basePipelineHandle = VK_NULL_HANDLE,
      .basePipelineIndex = -1};
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult made = device.api().vkCreateComputePipelines(
      device.handle(), device.pipeline_cache(), 1, &info, device.allocation(), &pipeline);
  Owned<VkPipeline> owned(device.handle(), pipeline, device.api().vkDestroyPipeline,
                          device.allocation());
  const auto created = device.check(made, fmt::format("vkCreateComputePipelines({})", spec.name()));
  if (!created) return created.error();
  device.name(VK_OBJECT_TYPE_PIPELINE, pipeline, spec.name());
  return owned;
}

}  // namespace

std::string KernelSpec::name() const {
  std::string text = shader.name;
  for (const std::uint32_t constant : constants) text += fmt::format(" {}", constant);
  return text;
}

Result<Kernel> Kernel::create(const Device& device, const KernelSpec& spec) {
  Kernel kernel;
  auto set_layout = create_set_layout(device, spec);
  if (!set_layout) return set_layout.error();
  kernel.set_layout_ = *std::move(set_layout);
  auto layout = create_layout(device, spec, kernel.set_layout_.get());
  if (!layout) return layout.error();
  kernel.layout_ = *std::move(layout);
  auto pipeline = create_pipeline(device, spec, kernel.layout_.get());
  if (!pipeline) return pipeline.error();
  kernel.pipeline_ = *std::move(pipeline);
  return kernel;
}

}  // namespace flowdlo::vulkan
