// Inputs for tests of single operations: seeded values, and a program around one operation.
#pragma once

#include <functional>
#include <vector>

#include "ops/program.hpp"
#include "random/philox.hpp"

namespace flowdlo::testing {

/// `count` standard normal values times `scale`.
inline std::vector<float> noise(std::size_t count, std::uint64_t seed, float scale = 1.0F) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = scale * random::gaussian(seed, i / 4)[i % 4];
  }
  return values;
}

}  // namespace flowdlo::testing
