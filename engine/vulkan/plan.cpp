#include "vulkan/plan.hpp"

#include <algorithm>
#include <limits>

namespace flowdlo::vulkan {

ops::Tensor Plan::tensor(Home home, std::string_view name, int rows, int columns,
                         std::vector<float> content) {
  const VkDeviceSize bytes =
      VkDeviceSize{4} * static_cast<VkDeviceSize>(rows) * static_cast<VkDeviceSize>(columns);
  return {resources_.add(home, bytes, name, std::move(content)), rows, columns};
}

Range Plan::rows(const ops::Tensor& tensor, Window window) const {
  const VkDeviceSize row_bytes = VkDeviceSize{4} * static_cast<VkDeviceSize>(tensor.columns);
  return {tensor.id, row_bytes * static_cast<VkDeviceSize>(window.first),
          row_bytes * static_cast<VkDeviceSize>(window.count)};
}

bool Plan::fits(const Range& range, VkDeviceSize bytes_a_texel) const {
  return range.size / bytes_a_texel <= device_->facts().limits.maxTexelBufferElements;
}

Range Plan::cut(Range range, VkDeviceSize bytes_a_texel) const {
  const VkDeviceSize most = bytes_a_texel * device_->facts().limits.maxTexelBufferElements;
  range.size = std::min(range.size, most);
  return range;
}

int Plan::most_texels() const {
  constexpr std::uint32_t kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(device_->facts().limits.maxTexelBufferElements, kMost));
}

std::vector<Window> Plan::windows(int rows, int most) {
  const int step = std::max(most / ops::kRowsPerDraw, 1) * ops::kRowsPerDraw;
  std::vector<Window> pieces;
  for (int first = 0; first < rows; first += step) {
    pieces.push_back({first, std::min(step, rows - first)});
  }
  return pieces;
}

void Plan::add(ShaderCode shader, bool uses_subgroups, std::vector<std::uint32_t> constants,
               Dispatch step) {
  KernelSpec spec{.shader = shader,
                  .constants = std::move(constants),
                  .bindings = {},
                  .push_bytes = static_cast<std::uint32_t>(step.push.size()),
                  .uses_subgroups = uses_subgroups};
  for (const Binding& binding : step.bindings) spec.bindings.push_back(binding.kind);
  const auto [entry, is_new] = kernel_index_.try_emplace(spec.name(), kernels_.size());
  step.kernel = entry->second;
  if (is_new) kernels_.push_back(std::move(spec));
  steps_.emplace_back(std::move(step));
}

}  // namespace flowdlo::vulkan
