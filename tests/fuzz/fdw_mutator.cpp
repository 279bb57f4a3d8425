// What libFuzzer does to an input, and then zeros up to a multiple of what a .fdw file is aligned
// to: without that no mutation of the length gets past the first check.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "weights/fdw.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  constexpr std::size_t kStep = flowdlo::weights::kDataAlignment;
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
  const std::size_t padded = (mutated + kStep - 1) / kStep * kStep;
  if (seed % 8 == 0 || padded > max_size) return mutated;
  std::fill(data + mutated, data + padded, std::uint8_t{0});
  return padded;
}
