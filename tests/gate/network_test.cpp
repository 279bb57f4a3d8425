#include "gate/network.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::gate {
namespace {

TEST(Network, AllZeroSaysZero) {
  const Network<3, 2> network;
  EXPECT_EQ(network({1, 2, 3})[0], 0);
  EXPECT_EQ(network({1, 2, 3})[1], 0);
}

TEST(Network, AddsWhatGoesStraightAndWhatIsBent) {
  Network<2, 1> network;
  network.straight[0] = {0.5, 2};
  network.hidden[3] = {1, -1};
  network.bent[0][3] = 4;
  EXPECT_DOUBLE_EQ(network({1, 3})[0], 0.5 + 6 + 4 * std::tanh(-2.0));
}

}  // namespace
}  // namespace flowdlo::gate
