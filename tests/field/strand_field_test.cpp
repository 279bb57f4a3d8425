#include "field/strand_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "reference/program.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::field {
namespace {

Network seeded() {
  auto made = Network::create(
      std::make_shared<const weights::FieldWeights>(weights::seeded_field({16, 16, 16}, 1)),
      [] { return reference::create_program(1); });
  if (!made) throw std::runtime_error(made.error().message);
  return *std::move(made);
}

TEST(StrandField, HasTheRegionsSize) {
  const testing::WaveFrame wave;
  auto network = seeded();
  const auto field = see(wave.frame(), 8, network);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->channels.size(), field->region.size);
}

TEST(StrandField, AMaskThatSpreadsFartherThanARopeIsRefused) {
  constexpr int kSide = 1200;  // a comb of hairs, which four times magnified is 23 million pixels
  const std::vector<float> depth_m(kSide * kSide, 0.5F);
  std::vector<std::uint8_t> mask(kSide * kSide, 0);
  for (std::size_t i = 0; i < mask.size(); i += 8) mask[i] = 255;
  auto network = seeded();
  const auto field = see({kSide, kSide, {900, 900, 600, 600}, depth_m, mask, {}}, 2, network);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, ErrorCode::kNoEvidence);
  EXPECT_NE(field.error().message.find("check the segmentation"), std::string::npos);
}

TEST(StrandField, ALongThinRopeIsMagnifiedLess) {
  constexpr int kSide = 420;  // a rope of 2 px, which four times magnified is 2.8 million pixels
  const std::vector<float> depth_m(kSide * kSide, 0.5F);
  std::vector<std::uint8_t> mask(kSide * kSide, 0);
  for (std::size_t i = 0; i < kSide; ++i) {
    for (const std::size_t u : {i, std::min<std::size_t>(i + 1, kSide - 1)}) {
      mask[i * kSide + u] = 255;
    }
  }
  auto network = seeded();
  const auto field = see({kSide, kSide, {400, 400, 210, 210}, depth_m, mask, {}}, 2, network);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_LE(field->channels.size().area(), kMostRegionPixels);
  EXPECT_LT(field->region.scale.x(), kMostScale);
  EXPECT_GE(field->region.scale.x(), kLeastWidth * kMostScale);
}

TEST(StrandField, AnEmptyMaskHasNone) {
  const testing::WaveFrame wave;
  const std::vector<std::uint8_t> none(wave.frame().mask.size(), 0);
  Frame frame = wave.frame();
  frame.mask = none;
  auto network = seeded();
  const auto field = see(frame, 8, network);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, ErrorCode::kNoEvidence);
}

}  // namespace
}  // namespace flowdlo::field
