#include "cpu/fma_peak.hpp"

#include <algorithm>
#include <chrono>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace flowdlo::bench {
namespace {

constexpr int kChains = 16;  // independent sums: two units of four cycles' latency need eight
constexpr int kRounds = 100000;
constexpr int kTries = 20;

using Clock = std::chrono::steady_clock;

/// Best of some tries of `loop`, which does kRounds * kChains multiply-adds of `lanes` floats.
template <class Loop>
double best_gflops(int lanes, const Loop& loop) {
  double best = 0;
  for (int i = 0; i < kTries; ++i) {
    const auto start = Clock::now();
    loop();
    const std::chrono::duration<double> took = Clock::now() - start;
    best = std::max(best, 2e-9 * kRounds * kChains * lanes / took.count());
  }
  return best;
}

#if defined(__x86_64__)
// The empty asm keeps the compiler from folding chains of equal values.
[[gnu::target("avx512f")]] void loop_of_512() {
  __m512 sums[kChains];
  for (auto& sum : sums) {
    sum = _mm512_setzero_ps();
    asm volatile("" : "+v"(sum));
  }
  const __m512 factor = _mm512_set1_ps(0.5F);
  for (int round = 0; round < kRounds; ++round) {
    for (auto& sum : sums) sum = _mm512_fmadd_ps(sum, factor, factor);
  }
  for (auto& sum : sums) asm volatile("" : "+v"(sum));
}

[[gnu::target("avx2,fma")]] void loop_of_256() {
  __m256 sums[kChains / 2];
  for (auto& sum : sums) {
    sum = _mm256_setzero_ps();
    asm volatile("" : "+x"(sum));
  }
  const __m256 factor = _mm256_set1_ps(0.5F);
  for (int round = 0; round < 2 * kRounds; ++round) {  // half as many chains: 16 registers
    for (auto& sum : sums) sum = _mm256_fmadd_ps(sum, factor, factor);
  }
  for (auto& sum : sums) asm volatile("" : "+x"(sum));
}
#endif

}  // namespace

double fma_peak_gflops(std::string_view isa) {
#if defined(__x86_64__)
  if (isa == "avx512") return best_gflops(16, loop_of_512);
  if (isa == "avx2") return best_gflops(8, loop_of_256);
#endif
  static_cast<void>(isa);
  return 0;
}

}  // namespace flowdlo::bench
