#include "vulkan/convolution_layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace flowdlo::vulkan {

std::vector<float> pack_convolution(std::span<const float> weight, int out, int taps, int in) {
  const int across = taps == 9 ? 3 : 1;
  std::vector<float> packed;
  packed.reserve(weight.size());
  for (int first = 0; first < out; first += kConvolutionOutputs) {
    for (int down = 0; down < across; ++down) {
      for (int channel = 0; channel < in; channel += 4) {
        for (int tap = down * across; tap < (down + 1) * across; ++tap) {
          for (int column = first; column < first + kConvolutionOutputs; ++column) {
            const auto four =
                weight.subspan((static_cast<std::size_t>(column) * taps + tap) * in + channel, 4);
            packed.insert(packed.end(), four.begin(), four.end());
          }
        }
      }
    }
  }
  return packed;
}

ConvolutionWeights keep_convolution(Plan& plan, std::string_view name, int out, int taps, int in,
                                    std::span<const float> weight, std::span<const float> bias) {
  const bool fits = (taps == 9 || taps == 1) && in > 0 && in % kConvolutionOutputs == 0 &&
                    out > 0 && out % kConvolutionOutputs == 0;
  if (!fits) {
    plan.fault(fmt::format("convolution \"{}\": expected [16 n, 9 or 1, 16 m], got [{}, {}, {}]",
                           name, out, taps, in));
    return {};
  }
  assert(weight.size() == static_cast<std::size_t>(out) * taps * in);
  assert(bias.size() == static_cast<std::size_t>(out));
  return {.in = in,
          .out = out,
          .taps = taps,
          .weight = plan.tensor(Home::kDevice, name, out, taps * in,
                                pack_convolution(weight, out, taps, in)),
          .bias = plan.tensor(Home::kDevice, name, 1, out, {bias.begin(), bias.end()})};
}

}  // namespace flowdlo::vulkan
