#include "flow/gaussian_source.hpp"

#include "flowdlo/centerline.hpp"
#include "random/philox.hpp"

namespace flowdlo::flow {

std::vector<float> gaussian_source(std::uint64_t seed, int draws) {
  std::vector<float> source;
  source.reserve(static_cast<std::size_t>(draws) * kNodes * 4);
  for (int draw = 0; draw < draws; ++draw) {
    for (int node = 0; node < kNodes; ++node) {
      const auto values = random::gaussian(seed, static_cast<std::uint64_t>(node),
                                           static_cast<std::uint64_t>(draw));
      source.insert(source.end(), {values[0], values[1], values[2], 0.0F});
    }
  }
  return source;
}

}  // namespace flowdlo::flow
