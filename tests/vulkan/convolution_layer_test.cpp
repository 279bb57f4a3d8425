#include "vulkan/convolution_layer.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace flowdlo::vulkan::testing {
namespace {

std::vector<float> counting(int size) {
  std::vector<float> values(static_cast<std::size_t>(size));
  std::iota(values.begin(), values.end(), 0.0F);
  return values;
}

TEST(PackConvolution, PutsFourInputsOfEachOutputSideBySide) {
  constexpr int kOut = 32;
  constexpr int kIn = 16;
  for (const int taps : {9, 1}) {
    const int across = taps == 9 ? 3 : 1;
    const auto weight = counting(kOut * taps * kIn);
    const auto packed = pack_convolution(weight, kOut, taps, kIn);
    ASSERT_EQ(packed.size(), weight.size());
    std::size_t next = 0;
    for (int group = 0; group < kOut / 16; ++group) {
      for (int down = 0; down < across; ++down) {
        for (int quad = 0; quad < kIn / 4; ++quad) {
          for (int right = 0; right < across; ++right) {
            for (int column = 0; column < 16; ++column) {
              for (int c = 0; c < 4; ++c) {
                const int tap = down * across + right;
                const int place = ((group * 16 + column) * taps + tap) * kIn + quad * 4 + c;
                ASSERT_EQ(packed[next++], static_cast<float>(place));
              }
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
