// Descriptors: the descriptor sets and buffer views of a plan, one for each distinct use.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

class Descriptors {
 public:
  /// `kernels` are those of plan.kernels(), in order; the resources are allocated.
  [[nodiscard]] static Result<Descriptors> create(const Device& device, const Plan& plan,
                                                  const std::vector<const Kernel*>& kernels);

  Descriptors() = default;

  /// Of the i-th dispatch of the plan.
  [[nodiscard]] VkDescriptorSet of(std::size_t dispatch) const { return sets_[dispatch]; }

 private:
  [[nodiscard]] Result<void> create_pool(const Device& device,
                                         const std::vector<const Dispatch*>& distinct);
  [[nodiscard]] Result<VkDescriptorSet> create_set(const Device& device, const Plan& plan,
                                                   const Dispatch& dispatch, const Kernel& kernel);
  [[nodiscard]] Result<VkBufferView> view_of(const Device& device, const Plan& plan,
                                             const Binding& binding);

  Owned<VkDescriptorPool> pool_;
  std::map<std::string, Owned<VkBufferView>> views_;
  std::vector<VkDescriptorSet> sets_;
};

}  // namespace flowdlo::vulkan
