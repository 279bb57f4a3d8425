// What libFuzzer does to an input, and then the checksums of its PNGs mended; one time in eight
// they stay wrong.
#include <cstddef>
#include <cstdint>

#include "png_file.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 8 != 0) flowdlo::fuzz::mend_png_checksums({data, mutated});
  return mutated;
}
