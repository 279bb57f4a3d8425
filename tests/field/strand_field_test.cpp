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
  constexpr int kSide = 1200;  // a comb of hairs, which three times magnified is 13 million pixels
  const std::vector<float> depth_m(kSide * kSide, 0.5F);
  std::vector<std::uint8_t> mask(kSide * kSide, 0);
  for (std::size_t i = 0; i < mask.size(); i += 8) mask[i] = 255;
  auto network = seeded();
  const auto field = see({kSide, kSide, {900, 900, 600, 600}, depth_m, mask, {}}, 2, network);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, ErrorCode::kNoEvidence);
  EXPECT_NE(field.error().message.find("check the segmentation"), std::string::npos);
}

/// A rope 2 px wide from corner to corner: three times magnified it is 4.7 million pixels.
class LongThinRope : public ::testing::Test {
 protected:
  static constexpr int kSide = 720;

  LongThinRope() {
    for (std::size_t i = 0; i < kSide; ++i) {
      for (const std::size_t u : {i, std::min<std::size_t>(i + 1, kSide - 1)}) {
        mask_[i * kSide + u] = 255;
      }
    }
  }

  [[nodiscard]] Frame frame() const {
    return {kSide, kSide, {400, 400, 360, 360}, depth_m_, mask_, {}};
  }

 private:
  std::vector<float> depth_m_ = std::vector<float>(kSide * kSide, 0.5F);
  std::vector<std::uint8_t> mask_ = std::vector<std::uint8_t>(kSide * kSide, 0);
};

TEST_F(LongThinRope, IsMagnifiedLess) {
  auto network = seeded();
  const auto field = see(frame(), 2, network);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_LE(field->channels.size().area(), kMostRegionPixels);
  EXPECT_LT(field->region.scale.x(), kMostScale);
  EXPECT_GE(field->region.scale.x(), kLeastWidth * kMostScale);
}

TEST_F(LongThinRope, CannotBeLookedAtMoreCloselyThanItFits) {
  auto network = seeded();
  const auto field = see(frame(), 2, network);
  ASSERT_TRUE(field) << field.error().message;
  const float before_px = field->region.magnified_for_px();
  EXPECT_GT(before_px, 2);
  EXPECT_FALSE(looks_closer(frame(), 1, before_px)) << "the region is as large as it gets";
  EXPECT_FALSE(looks_closer(frame(), before_px, before_px));
  EXPECT_TRUE(looks_closer(frame(), 2, 4 * before_px));
}

TEST(StrandField, ALookIsCloserByAGoodDealOrNotAtAll) {
  const testing::WaveFrame wave;
  EXPECT_TRUE(looks_closer(wave.frame(), 8 * 0.7F, 8));
  EXPECT_FALSE(looks_closer(wave.frame(), 8 * 0.95F, 8));
  EXPECT_FALSE(looks_closer(wave.frame(), 12, 8));
  const float all_seen_px = kRope_px / kAllSeenScale;
  EXPECT_TRUE(looks_closer(wave.frame(), 0.7F * all_seen_px, 1.01F * all_seen_px));
  EXPECT_FALSE(looks_closer(wave.frame(), 0.7F * all_seen_px, 0.99F * all_seen_px))
      << "there is nothing more to see";
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
  EXPECT_FALSE(looks_closer(frame, 8, 16));
}

}  // namespace
}  // namespace flowdlo::field
