// Plan: what a program will do, as a list of steps over resources, before any of it exists.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "ops/program.hpp"
#include "vulkan/device.hpp"
#include "vulkan/gemm_choice.hpp"
#include "vulkan/resources.hpp"

namespace flowdlo::vulkan {

struct Groups {
  std::uint32_t x = 1;
  std::uint32_t y = 1;
  std::uint32_t z = 1;
};

struct Dispatch {
  std::size_t kernel = 0;  ///< index into Plan::kernels()
  std::vector<Binding> bindings;
  std::vector<std::byte> push;
  Groups groups;
  std::optional<Range> indirect;  ///< a VkDispatchIndirectCommand instead of `groups`
};

struct CopyBytes {
  Range from;
  Range to;
};

struct StageMark {
  std::string name;
};

using Step = std::variant<Dispatch, CopyBytes, StageMark>;

/// Rows [first, first + count) of a tensor.
struct Window {
  int first = 0;
  int count = 0;
};

struct NoPush {};

class Plan {
 public:
  explicit Plan(const Device& device) : device_(&device) {}

  /// How dense layers run; before the first of them.
  void choose(const GemmChoice& gemm) {
    gemm_ = gemm;
    chosen_ = true;
  }

  /// Rows lie side by side, without a gap.
  [[nodiscard]] ops::Tensor tensor(Home home, std::string_view name, int rows, int columns,
                                   std::vector<float> content = {});
  /// What operations alone see: rows may lie further apart than they are long.
  [[nodiscard]] ops::Tensor scratch(std::string_view name, int rows, int columns);
  /// At least that many zeros in a row: an addend for a kernel that wants one.
  [[nodiscard]] Range zeros(int columns);
  /// Ones [rows, 4]: the validity of as many keys.
  [[nodiscard]] Range ones(int rows);
  [[nodiscard]] Range whole(const ops::Tensor& tensor) const { return resources_.whole(tensor.id); }
  /// Floats from one row to the next.
  [[nodiscard]] int pitch(const ops::Tensor& tensor) const;
  [[nodiscard]] Range rows(const ops::Tensor& tensor, Window window) const;

  /// Whether a texel buffer may hold the range.
  [[nodiscard]] bool fits(const Range& range, VkDeviceSize bytes_a_texel) const;
  /// The range cut to what a texel buffer may hold: for bindings that a kernel does not look at.
  [[nodiscard]] Range cut(Range range, VkDeviceSize bytes_a_texel) const;
  [[nodiscard]] int most_texels() const;
  /// `rows` in pieces of whole draws, none of more than `most` rows.
  [[nodiscard]] static std::vector<Window> windows(int rows, int most);

  /// Adds a run of the kernel that Call describes; see kernels.hpp.
  template <class Call>
  void dispatch(const Call& call, const typename Call::Constants& constants,
                const typename Call::Push& push, Groups groups,
                std::optional<Range> indirect = std::nullopt) {
    const auto bindings = call.bindings();
    Dispatch step;
    step.bindings.assign(bindings.begin(), bindings.end());
    step.groups = groups;
    step.indirect = indirect;
    if constexpr (!std::is_empty_v<typename Call::Push>) {
      step.push.resize(sizeof(push));
      std::memcpy(step.push.data(), &push, sizeof(push));
    }
    static_assert(sizeof(constants) % sizeof(std::uint32_t) == 0);
    std::vector<std::uint32_t> words(sizeof(constants) / sizeof(std::uint32_t));
    std::memcpy(words.data(), &constants, sizeof(constants));
    add(Call::shader(), Call::kUsesSubgroups, std::move(words), std::move(step));
  }
  /// Tensors of one shape.
  void copy(const ops::Tensor& from, const ops::Tensor& to);
  void stage(std::string_view name) { steps_.emplace_back(StageMark{std::string(name)}); }
  /// A recording that this device, or this room, cannot carry out; build() reports all of them.
  void fault(std::string text) { faults_.push_back(std::move(text)); }

  [[nodiscard]] const Device& device() const { return *device_; }
  /// What runs the dense layers.
  [[nodiscard]] const GemmChoice& gemm() const { return gemm_; }
  /// Whether lanes fetch a share each and hand it round: CPU drivers like that. A GPU's lanes all
  /// read from one address, or each what lies beside the others'.
  [[nodiscard]] bool hands_round() const {
    return gemm_.family == GemmFamily::kSimd && device_->facts().report.kind == DeviceKind::kCpu;
  }
  [[nodiscard]] int lanes() const { return device_->facts().lanes; }
  [[nodiscard]] Resources& resources() { return resources_; }
  [[nodiscard]] const Resources& resources() const { return resources_; }
  [[nodiscard]] const std::vector<KernelSpec>& kernels() const { return kernels_; }
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  void add(ShaderCode shader, bool uses_subgroups, std::vector<std::uint32_t> constants,
           Dispatch step);

  const Device* device_;
  GemmChoice gemm_;
  bool chosen_ = false;
  Resources resources_;
  std::optional<ops::Tensor> zeros_;
  std::map<int, ops::Tensor> ones_;  // by rows
  std::vector<KernelSpec> kernels_;
  std::map<std::string, std::size_t> kernel_index_;
  std::vector<Step> steps_;
  std::vector<std::string> faults_;
};

}  // namespace flowdlo::vulkan
