#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "weights/weights.hpp"

namespace flowdlo::weights {
namespace {

float largest(const std::vector<float>& values) {
  float result = 0;
  for (const float value : values) result = std::max(result, std::abs(value));
  return result;
}

TEST(Seeded, SameSeedGivesTheSameBits) {
  const auto first = seeded({}, 3);
  const auto second = seeded({}, 3);
  for (std::size_t i = 0; i < first.tensors.size(); ++i) {
    ASSERT_EQ(first.tensors[i].values, second.tensors[i].values) << first.tensors[i].name;
  }
}

TEST(Seeded, AnotherSeedGivesOtherValues) {
  EXPECT_NE(seeded({}, 3).at("state.weight").values, seeded({}, 4).at("state.weight").values);
}

TEST(Seeded, LayersOfOneShapeDiffer) {
  const auto weights = seeded({}, 3);
  EXPECT_NE(weights.at("encoder.0.up.weight").values, weights.at("encoder.1.up.weight").values);
}

TEST(Seeded, LinearLayersFillPyTorchsDefaultBound) {
  const auto weights = seeded({}, 1);
  EXPECT_LE(largest(weights.at("encoder.2.down.weight").values), 1.0F / 32.0F);
  EXPECT_GT(largest(weights.at("encoder.2.down.weight").values), 0.999F / 32.0F);
  EXPECT_LE(largest(weights.at("encoder.2.down.bias").values), 1.0F / 32.0F) << "in is 1024";
  EXPECT_LE(largest(weights.at("encoder.2.up.bias").values), 1.0F / 16.0F) << "in is 256";
  EXPECT_GT(largest(weights.at("encoder.2.up.bias").values), 1.0F / 32.0F);
  EXPECT_GT(largest(weights.at("support.bias").values), 0.9F) << "in is 1";
}

TEST(Seeded, NormsAreTheIdentityAndGammaIsOne) {
  const auto weights = seeded({}, 1);
  EXPECT_EQ(weights.at("norm.weight").values, std::vector<float>(256, 1.0F));
  EXPECT_EQ(weights.at("cross.norm_points.bias").values, std::vector<float>(256, 0.0F));
  EXPECT_EQ(weights.at("gamma").values, std::vector<float>{1.0F});
}

TEST(Seeded, NodeEmbeddingHasDeviationTwoHundredths) {
  const auto& values = seeded({}, 1).tensors;
  const auto node = std::find_if(values.begin(), values.end(),
                                 [](const Tensor& tensor) { return tensor.name == "node"; });
  double sum = 0;
  for (const float value : node->values) sum += double{value} * value;
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(node->values.size())), 0.02, 0.0005);
}

TEST(Seeded, SaysThatItIsNoTrainedModel) {
  const auto metadata = seeded({}, 1).metadata;
  EXPECT_EQ(metadata.name, "seeded-noise");
  EXPECT_EQ(metadata.training_data, "none");
  EXPECT_EQ(metadata.licence, "MIT");
  EXPECT_FALSE(metadata.trained);
}

TEST(Seeded, EveryVariantIsFaultless) {
  for (const int local : {6, 8}) {
    for (const int head : {3, 4}) {
      for (const bool visible : {false, true}) {
        const Variant variant{
            .local_channels = local, .visible_points = visible, .head_channels = head};
        EXPECT_TRUE(faults(seeded(variant, 9)).empty()) << local << head << visible;
      }
    }
  }
}

}  // namespace
}  // namespace flowdlo::weights
