#include "reference/kernels.hpp"

#include <array>

namespace flowdlo::reference {

#define FLOWDLO_ISA_KERNELS(name, widens_halves)                  \
  namespace name {                                                \
  void pack(const float* weight, int out, int in, float* panels); \
  void linear(const LinearBlock& block);                          \
  void narrow(const NarrowBlock& block);                          \
  void layer_norm(const LayerNormBlock& block);                   \
  void attention(const AttentionBlock& block);                    \
  void point_convolution(const PointRows& rows);                  \
  void square_convolution(const SquareBlocks& blocks);            \
  constexpr Kernels kKernels{#name,                               \
                             widens_halves,                       \
                             pack,                                \
                             linear,                              \
                             narrow,                              \
                             layer_norm,                          \
                             attention,                           \
                             point_convolution,                   \
                             square_convolution};                 \
  }

#if defined(__aarch64__)
FLOWDLO_ISA_KERNELS(neon, true)
#else
FLOWDLO_ISA_KERNELS(baseline, false)
#endif
#ifdef FLOWDLO_HAS_X86_ISAS
FLOWDLO_ISA_KERNELS(avx2, false)
FLOWDLO_ISA_KERNELS(avx512, false)
#endif
#undef FLOWDLO_ISA_KERNELS

std::span<const Kernels> kernels_of_this_cpu() {
#ifdef FLOWDLO_HAS_X86_ISAS
  static constexpr std::array<Kernels, 3> kAll{avx512::kKernels, avx2::kKernels,
                                               baseline::kKernels};
  const std::span<const Kernels> all(kAll);
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
                  __builtin_cpu_supports("avx512cd");
  return all.subspan(v4 ? 0 : v3 ? 1 : 2);
#elif defined(__aarch64__)
  static constexpr std::array<Kernels, 1> kAll{neon::kKernels};  // every ARM64 processor has NEON
  return kAll;
#else
  static constexpr std::array<Kernels, 1> kAll{baseline::kKernels};
  return kAll;
#endif
}

}  // namespace flowdlo::reference
