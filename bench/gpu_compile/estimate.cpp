#include "gpu_compile/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace flowdlo::gpu_compile {
namespace {

constexpr int kSimdsOfUnit = 2;
constexpr int kLanesOfSimd = 32;
constexpr double kInvocationsCounted = 64;  // of CompiledKernel::cycles_of_64
constexpr double kMs = 1e-6;                // of a cycle at 1 GHz
constexpr double kCloud = 20000;            // points, as in FrameWork
constexpr double kCloudShare = 2048;        // of a group of farthest_points
constexpr int kHeadChannels = 32;           // of attention
// ACO believes of each branch that half of the subgroups take it: of the convolution's first, by
// which blocks without any rope end at once, none does here.
constexpr double kConvolutionsAsBelieved = 0.5;
constexpr double kTexelBytes = 16;

double constant(const vulkan::KernelSpec& kernel, std::size_t index) {
  return static_cast<double>(static_cast<int>(kernel.constants.at(index)));
}

bool is(const vulkan::KernelSpec& kernel, std::string_view shader) {
  return kernel.shader.name == shader;
}

double texels(const vulkan::Dispatch& dispatch, std::size_t binding) {
  return static_cast<double>(dispatch.bindings.at(binding).range.size) / kTexelBytes;
}

double groups_of(const vulkan::Dispatch& dispatch) {
  if (dispatch.indirect) return std::ceil(kCloud / kCloudShare);
  return static_cast<double>(dispatch.groups.x) * dispatch.groups.y * dispatch.groups.z;
}

double keys_of(const vulkan::KernelSpec& kernel, const vulkan::Dispatch& dispatch) {
  const double few = constant(kernel, 3);
  return few > 0 ? few : texels(dispatch, 2);
}

/// Inputs of a layer that `gemm` runs.
double depth_of_simd(const vulkan::KernelSpec& kernel, const vulkan::Dispatch& dispatch) {
  const double weights = texels(dispatch, 1) * (constant(kernel, 6) > 0 ? 2 : 1);
  return 4 * weights / (dispatch.groups.y * constant(kernel, 0) * constant(kernel, 2));
}

double flop_of(const vulkan::KernelSpec& kernel, const vulkan::Dispatch& dispatch) {
  const double groups = groups_of(dispatch);
  if (is(kernel, "tile_gemm") || is(kernel, "matrix_gemm")) {
    return 2 * groups * constant(kernel, 1) * constant(kernel, 2) * constant(kernel, 4);
  }
  if (is(kernel, "gemm")) {
    return 2 * groups * constant(kernel, 0) * constant(kernel, 1) * constant(kernel, 2) *
           depth_of_simd(kernel, dispatch);
  }
  if (is(kernel, "attention")) {
    return 4 * groups * constant(kernel, 0) * constant(kernel, 1) * keys_of(kernel, dispatch) *
           kHeadChannels;
  }
  if (is(kernel, "convolution")) {  // weights and places, sixteen outputs a group
    return 2 * 4 * texels(dispatch, 3) * dispatch.groups.x * constant(kernel, 0) * 4;
  }
  return 0;
}

Share& share_of(FrameEstimate& estimate, const vulkan::KernelSpec& kernel) {
  const std::string_view shader = kernel.shader.name;
  if (shader.ends_with("gemm")) return estimate.dense;
  if (shader == "attention") return estimate.attention;
  if (shader == "convolution") return estimate.convolution;
  return shader.starts_with("farthest") ? estimate.visible_points : estimate.rest;
}

}  // namespace

const std::vector<Card>& cards() {
  static const std::vector<Card> all{{"navi21", "Radeon RX 6900 XT (Navi 21)", 80, 2.25},
                                     {"gfx1100", "Radeon RX 7900 XTX (Navi 31)", 96, 2.5},
                                     // The same card, as Mesa 25 names it, which makes pairs.
                                     {"navi31", "Radeon RX 7900 XTX (Navi 31)", 96, 2.5, 2}};
  return all;
}

double FrameEstimate::full_ms() const {
  return dense.full_ms + attention.full_ms + convolution.full_ms + visible_points.full_ms +
         rest.full_ms;
}

double FrameEstimate::dispatched_ms() const {
  return dense.dispatched_ms + attention.dispatched_ms + convolution.dispatched_ms +
         visible_points.dispatched_ms + rest.dispatched_ms;
}

std::vector<double> turns_of(const vulkan::KernelSpec& kernel, const vulkan::Dispatch& dispatch) {
  if (is(kernel, "tile_gemm") || is(kernel, "matrix_gemm")) {
    return {constant(kernel, 4) / constant(kernel, 3)};
  }
  if (is(kernel, "gemm")) return {depth_of_simd(kernel, dispatch) / 4 / constant(kernel, 3)};
  if (is(kernel, "attention")) return {keys_of(kernel, dispatch) / constant(kernel, 2)};
  if (is(kernel, "narrow")) return {16};
  if (is(kernel, "layer_norm") && constant(kernel, 1) == 1) return {16};
  if (is(kernel, "flow_step")) return {64};
  if (is(kernel, "convolution")) {
    const double taps = constant(kernel, 1);
    return {taps, texels(dispatch, 3) / (dispatch.groups.y * 16 * taps * taps)};
  }
  return {};
}

double with_turns(double cycles, const std::vector<double>& instructions_by_depth,
                  const std::vector<double>& turns) {
  constexpr double kGuess = 8;       // turns of a loop, as ACO counts,
  constexpr double kInnerGuess = 4;  // and of one within it
  const std::size_t loops = instructions_by_depth.size() - 1;
  if (turns.empty() || loops == 0) return cycles;
  // A compiler unrolls the outer loop of two where it has few turns: those left are the inner ones.
  const std::size_t unrolled = turns.size() > loops ? turns.size() - loops : 0;
  double guessed = 0;
  double real = 0;
  double guess = 1;
  double turn = 1;
  for (std::size_t depth = 0; depth <= loops; ++depth) {
    if (depth > 0) {
      guess *= depth == 1 ? kGuess : kInnerGuess;
      const std::size_t at = unrolled + depth - 1;
      turn *= at < turns.size() ? turns[at] : (depth == 1 ? kGuess : kInnerGuess);
    }
    guessed += guess * instructions_by_depth[depth];
    real += turn * instructions_by_depth[depth];
  }
  return guessed > 0 ? cycles * real / guessed : cycles;
}

FrameEstimate estimate(const FrameWork& work, const std::vector<CompiledKernel>& kernels,
                       const Card& card) {
  FrameEstimate total;
  const double simds = kSimdsOfUnit * card.compute_units;
  const double cycle_ms = kMs / card.clock_ghz;
  for (const vulkan::Dispatch& dispatch : work.dispatches) {
    const vulkan::KernelSpec& spec = work.kernels[dispatch.kernel];
    const CompiledKernel& kernel = kernels[dispatch.kernel];
    const std::vector<double> turns = turns_of(spec, dispatch);
    const double believed = is(spec, "convolution") ? kConvolutionsAsBelieved : 1;
    const auto real = [&](double cycles_of_compiler) {
      return with_turns(cycles_of_compiler, kernel.instructions_by_depth, turns) / believed;
    };
    const double cycles = real(kernel.cycles_of_64);
    const double alone = real(kernel.latency);
    const double threads = constant(spec, 0);
    const double subgroups = groups_of(dispatch) * std::ceil(threads / kernel.subgroup);
    const double invocations = subgroups * kernel.subgroup;
    const double busiest = std::ceil(subgroups / simds) * kernel.subgroup;
    const double flop = flop_of(spec, dispatch);

    Share& share = share_of(total, spec);
    share.dispatches += 1;
    share.flop += flop;
    share.limit_ms += flop / 2 / (simds * kLanesOfSimd * card.multiply_adds) * cycle_ms;
    share.full_ms += invocations / kInvocationsCounted * cycles / simds * cycle_ms;
    share.dispatched_ms += std::max(alone, busiest / kInvocationsCounted * cycles) * cycle_ms;
  }
  return total;
}

}  // namespace flowdlo::gpu_compile
