#include "weights/field_weights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "frame/temporary_folder.hpp"

namespace flowdlo::weights {
namespace {

using testing::HasSubstr;

class FieldWeightsTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "field.safetensors"; }
  [[nodiscard]] std::string text() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(file(), std::ios::binary) << bytes; }
  [[nodiscard]] std::string fault() const {
    const auto loaded = load_field(file());
    return loaded ? "" : loaded.error().message;
  }

  test::TemporaryFolder folder_;
  FieldWeights weights_ = seeded_field({16, 32, 48}, 9);
};

TEST_F(FieldWeightsTest, ComesBackWithinTheRoundingOfF16) {
  weights_.name = "field of a test";
  weights_.notes = "notes, \"quoted\"";
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->name, weights_.name);
  EXPECT_EQ(loaded->notes, weights_.notes);
  EXPECT_EQ(loaded->sizes, weights_.sizes);
  ASSERT_EQ(loaded->tensors.size(), weights_.tensors.size());
  for (std::size_t t = 0; t < weights_.tensors.size(); ++t) {
    EXPECT_EQ(loaded->tensors[t].shape, weights_.tensors[t].shape);
    for (std::size_t i = 0; i < weights_.tensors[t].values.size(); ++i) {
      const float want = weights_.tensors[t].values[i];
      ASSERT_NEAR(loaded->tensors[t].values[i], want, 1e-3F * std::abs(want) + 1e-7F);
    }
  }
}

TEST_F(FieldWeightsTest, ManifestHasAWeightAndABiasOfEveryConvolution) {
  const auto manifest = field_manifest({16, 32, 48});
  ASSERT_EQ(manifest.size(), 28U);
  EXPECT_EQ(manifest.front().name, "down_fine.0.weight");
  EXPECT_EQ(manifest.front().shape, (std::vector<int>{16, 9, kFieldInputs}));
  EXPECT_EQ(manifest.back().name, "head.bias");
  EXPECT_EQ(manifest.back().shape, std::vector<int>{kFieldOutputs});
}

TEST_F(FieldWeightsTest, AMissingFileSaysSo) {
  EXPECT_THAT(fault(), HasSubstr("field.safetensors"));
}

TEST_F(FieldWeightsTest, AChangedBitIsFound) {
  ASSERT_TRUE(save_field(weights_, file()));
  std::string bytes = text();
  bytes[bytes.size() - 3] = static_cast<char>(bytes[bytes.size() - 3] ^ 1);
  write(bytes);
  EXPECT_THAT(fault(), HasSubstr("SHA-256"));
}

TEST_F(FieldWeightsTest, AFileThatEndsEarlyIsRefused) {
  ASSERT_TRUE(save_field(weights_, file()));
  const std::string bytes = text();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{5}, bytes.size() / 2, bytes.size() - 1}) {
    write(bytes.substr(0, size));
    EXPECT_NE(fault(), "") << size;
  }
}

TEST_F(FieldWeightsTest, SizesThatNoKernelTakesAreRefused) {
  ASSERT_TRUE(save_field(weights_, file()));
  std::string bytes = text();
  const auto at = bytes.find("\"fine\":\"16\"");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 11, "\"fine\":\"17\"");
  write(bytes);
  EXPECT_THAT(fault(), HasSubstr("metadata fine: expected a multiple of 16"));
}

TEST_F(FieldWeightsTest, WhatIsNoNumberIsNotWritten) {
  weights_.tensors[3].values[0] = std::numeric_limits<float>::quiet_NaN();
  const auto saved = save_field(weights_, file());
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kBadWeights);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(FieldWeightsTest, TensorsOfAnotherNetworkAreRefused) {
  weights_.tensors.pop_back();
  EXPECT_FALSE(save_field(weights_, file()));
}

TEST_F(FieldWeightsTest, MoreChannelsThanKernelsTakeAreRefused) {
  const std::vector<std::pair<FieldSizes, const char*>> wide{
      {{64, 32, 48}, "metadata fine: expected a multiple of 16 up to 48, got \"64\""},
      {{16, 176, 48}, "metadata middle: expected a multiple of 16 up to 160, got \"176\""},
      {{16, 32, 464}, "metadata coarse: expected a multiple of 16 up to 448, got \"464\""}};
  for (const auto& [sizes, message] : wide) {
    ASSERT_TRUE(save_field(seeded_field(sizes, 9), file()));
    EXPECT_THAT(fault(), HasSubstr(message));
  }
  ASSERT_TRUE(save_field(seeded_field({48, 160, 448}, 9), file()));
  EXPECT_EQ(fault(), "");
}

TEST_F(FieldWeightsTest, TheNetworkThatRefinesComesBackBesideTheField) {
  weights_.refine = seeded_refine(3);
  weights_.refine->notes = "trained on nothing";
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(loaded->refine);
  EXPECT_EQ(loaded->refine->notes, "trained on nothing");
  EXPECT_EQ(loaded->tensors.size(), weights_.tensors.size());
  ASSERT_EQ(loaded->refine->tensors.size(), refine_manifest().size());
  const Tensor& got = loaded->refine->at("square.1.weight");
  const Tensor& want = weights_.refine->at("square.1.weight");
  EXPECT_EQ(got.shape, want.shape);
  for (std::size_t i = 0; i < want.values.size(); ++i) {
    ASSERT_NEAR(got.values[i], want.values[i], 1e-3F * std::abs(want.values[i]) + 1e-7F);
  }
}

TEST_F(FieldWeightsTest, AFileWithoutTheNetworkThatRefinesIsFine) {
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded);
  EXPECT_FALSE(loaded->refine);
}

TEST_F(FieldWeightsTest, AnotherVersionOfTheNetworkThatRefinesIsRefused) {
  weights_.refine = seeded_refine(3);
  ASSERT_TRUE(save_field(weights_, file()));
  std::string bytes = text();
  const auto at = bytes.find("\"refine\":\"2\"");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 12, "\"refine\":\"1\"");
  write(bytes);
  EXPECT_THAT(fault(), HasSubstr("metadata refine: expected \"2\""));
}

TEST_F(FieldWeightsTest, TensorsOfANetworkThatRefinesNeedItsVersion) {
  weights_.refine = seeded_refine(3);
  weights_.refine->tensors.pop_back();
  EXPECT_FALSE(save_field(weights_, file()));  // one is missing
  weights_.refine = seeded_refine(3);
  ASSERT_TRUE(save_field(weights_, file()));
  std::string bytes = text();
  const auto at = bytes.find("\"refine\":");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 8, "\"refin_\"");
  write(bytes);
  EXPECT_THAT(fault(), HasSubstr("refine.stem.weight"));
}

TEST_F(FieldWeightsTest, TheNetworkThatLinksComesBackBesideBoth) {
  weights_.refine = seeded_refine(3);
  weights_.links = seeded_links(4);
  weights_.links->notes = "fitted to nothing";
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(loaded->links);
  ASSERT_TRUE(loaded->refine);
  EXPECT_EQ(loaded->links->notes, "fitted to nothing");
  EXPECT_EQ(loaded->tensors.size(), weights_.tensors.size());
  EXPECT_EQ(loaded->refine->tensors.size(), refine_manifest().size());
  ASSERT_EQ(loaded->links->tensors.size(), links_manifest().size());
  for (const char* const name : {"hidden", "bent", "straight"}) {
    const Tensor& got = loaded->links->at(name);
    const Tensor& want = weights_.links->at(name);
    EXPECT_EQ(got.shape, want.shape);
    for (std::size_t i = 0; i < want.values.size(); ++i) {
      ASSERT_NEAR(got.values[i], want.values[i], 1e-3F * std::abs(want.values[i]) + 1e-7F);
    }
  }
}

TEST_F(FieldWeightsTest, AnotherVersionOfTheNetworkThatLinksIsRefused) {
  weights_.links = seeded_links(4);
  ASSERT_TRUE(save_field(weights_, file()));
  std::string bytes = text();
  const auto at = bytes.find("\"links\":\"1\"");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 11, "\"links\":\"2\"");
  write(bytes);
  EXPECT_THAT(fault(), HasSubstr("metadata links: expected \"1\""));
}

TEST_F(FieldWeightsTest, TheNetworkThatFindsTipsComesBackBehindTheOthers) {
  weights_.refine = seeded_refine(3);
  weights_.links = seeded_links(4);
  weights_.tips = seeded_tips(5);
  weights_.tips->notes = "fitted to nothing";
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(loaded->tips);
  EXPECT_EQ(loaded->tips->notes, "fitted to nothing");
  EXPECT_EQ(loaded->tensors.size(), weights_.tensors.size());
  EXPECT_EQ(loaded->links->at("bent").shape, weights_.links->at("bent").shape);
  for (const char* const name : {"hidden", "bent", "straight"}) {
    const Tensor& got = loaded->tips->at(name);
    const Tensor& want = weights_.tips->at(name);
    EXPECT_EQ(got.shape, want.shape);
    for (std::size_t i = 0; i < want.values.size(); ++i) {
      ASSERT_NEAR(got.values[i], want.values[i], 1e-3F * std::abs(want.values[i]) + 1e-7F);
    }
  }
}

TEST_F(FieldWeightsTest, AFileWithoutANetworkOfTipsHasNone) {
  weights_.links = seeded_links(4);
  ASSERT_TRUE(save_field(weights_, file()));
  const auto loaded = load_field(file());
  ASSERT_TRUE(loaded);
  EXPECT_FALSE(loaded->tips);
}

TEST_F(FieldWeightsTest, TensorsOfANetworkThatLinksAreChecked) {
  weights_.links = seeded_links(4);
  weights_.links->tensors.back().values.pop_back();
  weights_.links->tensors.back().shape = {kLinkInputs - 1};
  EXPECT_FALSE(save_field(weights_, file()));
}

}  // namespace
}  // namespace flowdlo::weights
