#include "reference/kernels.hpp"

namespace flowdlo::reference {

#define FLOWDLO_DECLARE_ISA(name)               \
  namespace name {                              \
  void linear(const LinearBlock& block);        \
  void narrow(const NarrowBlock& block);        \
  void layer_norm(const LayerNormBlock& block); \
  void attention(const AttentionBlock& block);  \
  }

FLOWDLO_DECLARE_ISA(baseline)
#ifdef FLOWDLO_HAS_X86_ISAS
FLOWDLO_DECLARE_ISA(avx2)
FLOWDLO_DECLARE_ISA(avx512)
#endif
#undef FLOWDLO_DECLARE_ISA

Kernels kernels_of_this_cpu() {
#ifdef FLOWDLO_HAS_X86_ISAS
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi2");
  if (v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512cd")) {
    return {"avx512", avx512::linear, avx512::narrow, avx512::layer_norm, avx512::attention};
  }
  if (v3) {
    return {"avx2", avx2::linear, avx2::narrow, avx2::layer_norm, avx2::attention};
  }
#endif
  return {"baseline", baseline::linear, baseline::narrow, baseline::layer_norm,
          baseline::attention};
}

}  // namespace flowdlo::reference
