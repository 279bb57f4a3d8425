#include <gtest/gtest.h>

#include "flowdlo/weights.hpp"
#include "weights/weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo {
namespace {

using test::WeightsFolder;

TEST(InspectWeights, TellsTensorsParametersAndMetadata) {
  const WeightsFolder folder;
  ASSERT_TRUE(weights::save(weights::seeded({}, 1), folder / "model.fdw"));
  const auto info = inspect_weights(folder / "model.fdw");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->parameters, 5815044);
  EXPECT_EQ(info->tensors.front().name, "state.weight");
  EXPECT_EQ(info->tensors.front().shape, (std::vector{256, 3}));
  EXPECT_EQ(info->tensors.front().dtype, "f16");
  EXPECT_EQ(info->metadata.at("name"), "seeded-noise");
  EXPECT_EQ(info->metadata.at("trained"), "false");
  EXPECT_EQ(info->metadata.at("parameterization"), "velocity");
  EXPECT_EQ(info->metadata.at("mean"), "0,0,0.4");
  EXPECT_EQ(info->sha256.size(), 64U);
}

TEST(InspectWeights, TellsF32) {
  const WeightsFolder folder;
  ASSERT_TRUE(
      weights::save(weights::seeded({}, 1), folder / "model.fdw", weights::StorageType::kF32));
  const auto info = inspect_weights(folder / "model.fdw");
  ASSERT_TRUE(info) << info.error().message;
  for (const auto& tensor : info->tensors) EXPECT_EQ(tensor.dtype, "f32");
}

TEST(InspectWeights, MissingFileIsAnIoError) {
  const auto info = inspect_weights("no/such.fdw");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace flowdlo
