#include "flow/time_embedding.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo {
namespace {

/// Weights whose time layers are identities without bias: the token is then SiLU of the sinusoids.
weights::Weights transparent() {
  auto weights = weights::seeded({}, 1);
  for (auto& tensor : weights.tensors) {
    if (tensor.name.rfind("time.", 0) != 0) continue;
    std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
    if (tensor.shape.size() != 2) continue;
    for (std::size_t i = 0; i < 256; ++i) tensor.values[i * 257] = 1.0F;
  }
  return weights;
}

double silu(double x) { return x / (1 + std::exp(-x)); }

TEST(TimeEmbedding, HoldsSinesThenCosinesOfAThousandT) {  // spec section 6, `time`
  const auto tokens = flow::time_tokens(transparent(), 4);
  ASSERT_EQ(tokens.size(), 4U * 256U);
  const float* third = tokens.data() + 2 * 256;  // t = 0.5
  EXPECT_NEAR(third[0], silu(std::sin(500.0)), 1e-6);
  EXPECT_NEAR(third[128], silu(std::cos(500.0)), 1e-6);
  EXPECT_NEAR(third[64], silu(std::sin(500.0 * std::pow(10000.0, -0.5))), 1e-6);
  EXPECT_NEAR(third[255], silu(std::cos(500.0 * std::pow(10000.0, -127.0 / 128))), 1e-6);
}

TEST(TimeEmbedding, FirstStepIsTimeZero) {  // Eq. (3.26): t_0 = 0
  const auto tokens = flow::time_tokens(transparent(), 10);
  EXPECT_NEAR(tokens[0], 0.0, 1e-7);
  EXPECT_NEAR(tokens[128], silu(1.0), 1e-6);
}

}  // namespace
}  // namespace flowdlo
