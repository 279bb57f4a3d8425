#include "vulkan/recording.hpp"

#include <fmt/format.h>

#include <set>

#include "vulkan/hazards.hpp"

namespace flowdlo::vulkan {
namespace {

class Recorder {
 public:
  Recorder(const Device& device, const Plan& plan, const Compiled& compiled,
           VkCommandBuffer commands)
      : device_(device), plan_(plan), compiled_(compiled), commands_(commands) {}

  void dispatch(const Dispatch& step, std::size_t index) {
    wait_for(step);
    const VolkDeviceTable& api = device_.api();
    const Kernel& kernel = *compiled_.kernels[step.kernel];
    const VkDescriptorSet set = compiled_.descriptors.of(index);
    api.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    api.vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1,
                                &set, 0, nullptr);
    if (!step.push.empty()) {
      api.vkCmdPushConstants(commands_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                             static_cast<std::uint32_t>(step.push.size()), step.push.data());
    }
    if (step.indirect) {
      const Resources::Place place = plan_.resources().place(*step.indirect);
      api.vkCmdDispatchIndirect(commands_, place.buffer, place.offset);
    } else {
      api.vkCmdDispatch(commands_, step.groups.x, step.groups.y, step.groups.z);
    }
  }

  void copy(const CopyBytes& step) {
    if (hazards_.conflict(step.from, false) || hazards_.conflict(step.to, true)) barrier();
    hazards_.add(step.from, false);
    hazards_.add(step.to, true);
    const Resources::Place from = plan_.resources().place(step.from);
    const Resources::Place to = plan_.resources().place(step.to);
    const VkBufferCopy region{
        .srcOffset = from.offset, .dstOffset = to.offset, .size = step.from.size};
    device_.api().vkCmdCopyBuffer(commands_, from.buffer, to.buffer, 1, &region);
  }

  void show_host() const { barrier(VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT); }

 private:
  void wait_for(const Dispatch& step) {
    bool conflict = step.indirect && hazards_.conflict(*step.indirect, false);
    for (const Binding& binding : step.bindings) {
      conflict = conflict || hazards_.conflict(binding.range, binding.writes);
    }
    if (conflict) barrier();
    if (step.indirect) hazards_.add(*step.indirect, false);
    for (const Binding& binding : step.bindings) hazards_.add(binding.range, binding.writes);
  }

  void barrier() {
    barrier(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
                VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    hazards_.clear();
  }

  void barrier(VkPipelineStageFlags next, VkAccessFlags access) const {
    const VkMemoryBarrier memory{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .pNext = nullptr,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = access};
    // Reads by dispatch-indirect come before later writes too.
    device_.api().vkCmdPipelineBarrier(commands_,
                                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                           VK_PIPELINE_STAGE_TRANSFER_BIT |
                                           VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                                       next, 0, 1, &memory, 0, nullptr, 0, nullptr);
  }

  const Device& device_;
  const Plan& plan_;
  const Compiled& compiled_;
  VkCommandBuffer commands_;
  Hazards hazards_;
};

/// Kernel and sizes: drivers specialise code by what a view looks like, never by where it starts.
std::string shape_of(const Dispatch& dispatch) {
  std::string shape = fmt::format("{}", dispatch.kernel);
  for (const Binding& binding : dispatch.bindings) shape += fmt::format(" {}", binding.range.size);
  return shape;
}

}  // namespace

void record_run(const Device& device, const Plan& plan, const Compiled& compiled,
                const Timestamps& timestamps, VkCommandBuffer commands) {
  Recorder recorder(device, plan, compiled, commands);
  timestamps.reset(device, commands);
  std::uint32_t timestamp = 0;
  timestamps.write(device, commands, timestamp++);
  std::size_t dispatches = 0;
  for (const Step& step : plan.steps()) {
    if (const auto* dispatch = std::get_if<Dispatch>(&step)) {
      recorder.dispatch(*dispatch, dispatches++);
    } else if (const auto* copy = std::get_if<CopyBytes>(&step)) {
      recorder.copy(*copy);
    } else {
      timestamps.write(device, commands, timestamp++);
    }
  }
  timestamps.write(device, commands, timestamp);
  recorder.show_host();
}

void record_warm_up(const Device& device, const Plan& plan, const Compiled& compiled,
                    VkCommandBuffer commands) {
  Recorder recorder(device, plan, compiled, commands);
  std::set<std::string> seen;
  std::size_t dispatches = 0;
  for (const Step& step : plan.steps()) {
    const auto* dispatch = std::get_if<Dispatch>(&step);
    if (dispatch == nullptr) continue;
    const std::size_t index = dispatches++;
    if (seen.insert(shape_of(*dispatch)).second) recorder.dispatch(*dispatch, index);
  }
  recorder.show_host();
}

std::vector<std::string> stage_names(const Plan& plan) {
  std::vector<std::string> names{"start"};
  for (const Step& step : plan.steps()) {
    if (const auto* mark = std::get_if<StageMark>(&step)) names.push_back(mark->name);
  }
  return names;
}

}  // namespace flowdlo::vulkan
