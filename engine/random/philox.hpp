// Philox 4x32-10: a counter-based generator. The value at an index depends on (seed, index) alone,
// so that any order of evaluation, on any back end, gives the same bits.
// Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
#pragma once

#include <array>
#include <cstdint>

namespace flowdlo::random {

/// Four 32-bit words of block `counter` of stream `stream` under `seed`.
[[nodiscard]] std::array<std::uint32_t, 4> philox(std::uint64_t seed, std::uint64_t counter,
                                                  std::uint64_t stream = 0);

/// The raw bijection on (counter, key), for the known-answer tests.
[[nodiscard]] std::array<std::uint32_t, 4> philox_4x32_10(std::array<std::uint32_t, 4> counter,
                                                          std::array<std::uint32_t, 2> key);

/// In (0, 1): (word + 0.5) / 2^32.
[[nodiscard]] double uniform(std::uint32_t word);

/// Four standard normal values of one block (Box-Muller in double, rounded to float).
[[nodiscard]] std::array<float, 4> gaussian(std::uint64_t seed, std::uint64_t counter,
                                            std::uint64_t stream = 0);

}  // namespace flowdlo::random
