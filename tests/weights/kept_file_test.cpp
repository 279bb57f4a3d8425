#include "weights/kept_file.hpp"

#include <gtest/gtest.h>

#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

using test::WeightsFolder;

void expect_equal(const Weights& got, const Weights& expected) {
  ASSERT_EQ(got.tensors.size(), expected.tensors.size());
  for (std::size_t i = 0; i < expected.tensors.size(); ++i) {
    EXPECT_EQ(got.tensors[i].name, expected.tensors[i].name);
    EXPECT_EQ(got.tensors[i].values, expected.tensors[i].values) << expected.tensors[i].name;
  }
  EXPECT_EQ(got.metadata.variant, expected.metadata.variant);
}

TEST(KeptFile, DecodesToWhatWasLoadedWhenTheFileIsGone) {
  for (const StorageType type : {StorageType::kF16, StorageType::kF32}) {
    const WeightsFolder folder;
    ASSERT_TRUE(save(seeded({}, 3), folder / "model.fdw", type));
    const auto loaded = load(folder / "model.fdw");
    const auto kept = keep({folder / "model.fdw", {}});
    ASSERT_TRUE(loaded && kept);

    std::filesystem::remove(folder / "model.fdw");

    expect_equal(kept->decoded(), *loaded);
    EXPECT_EQ(kept->metadata().variant, loaded->metadata.variant);
  }
}

TEST(KeptFile, RefusesWhatLoadRefuses) {
  const WeightsFolder folder;
  EXPECT_FALSE(keep({folder / "none.fdw", {}}));
}

}  // namespace
}  // namespace flowdlo::weights
