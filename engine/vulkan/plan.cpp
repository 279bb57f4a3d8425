#include "vulkan/plan.hpp"

#include <algorithm>
#include <limits>

namespace flowdlo::vulkan {
namespace {

// Rows of these many bytes begin in one and the same set of a first-level cache: the 32 rows that a
// subgroup of gemm reads side by side would drive one another out. 256 bytes between them spread
// them, and leave four draws the size that lavapipe takes for one of kView.
constexpr int kSetBytes = 4096;
constexpr int kGap = 64;
// Lavapipe 22.3 compiles a kernel once for views whose size is a multiple of this and once more for
// others, binding by binding: it takes bits of the size for something of a texture's.
constexpr int kView = 65536;

}  // namespace

ops::Tensor Plan::tensor(Home home, std::string_view name, int rows, int columns,
                         std::vector<float> content) {
  const VkDeviceSize bytes =
      VkDeviceSize{4} * static_cast<VkDeviceSize>(rows) * static_cast<VkDeviceSize>(columns);
  return {resources_.add(home, bytes, name, std::move(content)), rows, columns};
}

ops::Tensor Plan::scratch(std::string_view name, int rows, int columns) {
  const bool spreads =
      chosen_ && hands_round() && columns * static_cast<int>(sizeof(float)) % kSetBytes == 0;
  const ops::Tensor placed = tensor(Home::kDevice, name, rows, spreads ? columns + kGap : columns);
  return {placed.id, rows, columns};
}

Range Plan::zeros(int columns) {
  constexpr int kColumns = kView / static_cast<int>(sizeof(float));
  if (!zeros_ || zeros_->columns < columns) {
    zeros_ = tensor(Home::kDevice, "zeros", 1, (columns + kColumns - 1) / kColumns * kColumns);
  }
  return whole(*zeros_);
}

Range Plan::ones(int rows) {
  const auto known = ones_.find(rows);
  if (known != ones_.end()) return whole(known->second);
  const std::vector<float> content(static_cast<std::size_t>(rows) * 4, 1.0F);
  return whole(ones_.emplace(rows, tensor(Home::kDevice, "ones", rows, 4, content)).first->second);
}

int Plan::pitch(const ops::Tensor& tensor) const {
  const VkDeviceSize floats = whole(tensor).size / sizeof(float);
  return static_cast<int>(floats / static_cast<VkDeviceSize>(tensor.rows));
}

void Plan::copy(const ops::Tensor& from, const ops::Tensor& to) {
  if (pitch(from) == from.columns && pitch(to) == to.columns) {
    steps_.emplace_back(CopyBytes{whole(from), whole(to)});
    return;
  }
  const VkDeviceSize bytes = sizeof(float) * static_cast<VkDeviceSize>(from.columns);
  for (int row = 0; row < from.rows; ++row) {
    Range source = rows(from, {row, 1});
    Range target = rows(to, {row, 1});
    source.size = target.size = bytes;
    steps_.emplace_back(CopyBytes{source, target});
  }
}

Range Plan::rows(const ops::Tensor& tensor, Window window) const {
  const VkDeviceSize row_bytes = VkDeviceSize{4} * static_cast<VkDeviceSize>(pitch(tensor));
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
