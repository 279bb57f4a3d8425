// What cleaning mends, and what it leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "flowdlo/mask.hpp"
#include "mask/table_scene.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::pixels_of;

constexpr int kSide = 640;
constexpr MaskCleaning kNothing{.smooth = false, .fill_holes_px2 = 0, .least_piece_px2 = 0};

Mask with(Mask mask, int u, int v, int width, int height, std::uint8_t value) {
  for (int y = v; y < v + height; ++y) {
    for (int x = u; x < u + width; ++x) {
      mask[static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)] = value;
    }
  }
  return mask;
}

Mask blank() { return Mask(std::size_t{kSide} * kSide, 0); }

Mask cleaned(const Mask& mask, const MaskCleaning& cleaning) {
  const auto done = clean_mask(kSide, kSide, mask, cleaning);
  return done ? *done : Mask{};
}

TEST(CleanMask, FillsAHoleUpToTheAreaAndNoneBeyond) {
  const Mask bar = with(blank(), 100, 100, 200, 40, 255);
  const Mask holed = with(with(bar, 120, 110, 6, 10, 0), 200, 110, 6, 11, 0);
  auto cleaning = kNothing;
  cleaning.fill_holes_px2 = 60;
  EXPECT_EQ(cleaned(holed, cleaning), with(bar, 200, 110, 6, 11, 0));
}

TEST(CleanMask, LeavesTheImagesCornersAlone) {  // small, but no hole of anything
  const Mask full = with(blank(), 0, 0, kSide, kSide, 255);
  const Mask cut = with(full, 0, 0, 3, 3, 0);
  auto cleaning = kNothing;
  cleaning.fill_holes_px2 = 60;
  EXPECT_EQ(cleaned(cut, cleaning), cut);
}

TEST(CleanMask, TakesALineOnePixelWideForTheBorderOfAHole) {
  Mask diamond = blank();
  for (int i = 0; i <= 3; ++i) {  // its pixels touch at corners only
    for (const auto& [u, v] :
         {std::pair{100 + i, 97 + i}, {100 - i, 97 + i}, {100 + i, 103 - i}, {100 - i, 103 - i}}) {
      diamond = with(diamond, u, v, 1, 1, 255);
    }
  }
  auto cleaning = kNothing;
  cleaning.fill_holes_px2 = 60;
  EXPECT_EQ(cleaned(diamond, cleaning)[100 * kSide + 100], 255);
}

TEST(CleanMask, LeavesPiecesBelowTheAreaOut) {
  const Mask two = with(with(blank(), 100, 100, 6, 10, 255), 300, 300, 59, 1, 255);
  auto cleaning = kNothing;
  cleaning.least_piece_px2 = 60;
  EXPECT_EQ(cleaned(two, cleaning), with(blank(), 100, 100, 6, 10, 255));
}

TEST(CleanMask, CountsAreasOfAnImage640PixelsWide) {
  Mask mask(320 * 320, 0);
  for (int u = 0; u < 20; ++u) mask[100 * 320 + static_cast<std::size_t>(u)] = 255;
  auto cleaning = kNothing;
  cleaning.least_piece_px2 = 60;  // 15 here
  const auto done = clean_mask(320, 320, mask, cleaning);
  ASSERT_TRUE(done);
  EXPECT_EQ(pixels_of(*done), 20);
}

TEST(CleanMask, SmoothsLonePixelsAwayAndKeepsALine) {
  Mask mask = with(blank(), 10, 10, 1, 1, 255);
  mask = with(mask, 50, 50, 100, 2, 255);
  mask = with(mask, 50, 100, 100, 9, 255);
  mask = with(mask, 80, 104, 1, 1, 0);
  auto cleaning = kNothing;
  cleaning.smooth = true;
  const Mask done = cleaned(mask, cleaning);
  EXPECT_EQ(pixels_of(done), 200U + 900U);
}

TEST(CleanMask, TakesWhatIsOver127AndNothingElse) {
  Mask mask = with(with(blank(), 0, 0, 20, 20, 127), 100, 100, 20, 20, 128);
  EXPECT_EQ(pixels_of(cleaned(mask, kNothing)), 400U);
}

TEST(CleanMask, NamesEveryFault) {
  const Mask mask(12, 0);
  const auto done =
      clean_mask(4, 3, mask, {.smooth = true, .fill_holes_px2 = -1, .least_piece_px2 = 1e7F});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(done.error().message, HasSubstr("fill_holes_px2: expected 0 to"));
  EXPECT_THAT(done.error().message, HasSubstr("least_piece_px2: expected 0 to"));
  EXPECT_THAT(clean_mask(5, 3, mask).error().message, HasSubstr("expected 15 values, got 12"));
  EXPECT_THAT(clean_mask(0, 5000, mask).error().message, HasSubstr("got 0 x 5000"));
  EXPECT_FALSE(clean_mask(4, 3, mask, {.fill_holes_px2 = std::numeric_limits<float>::quiet_NaN()}));
}

}  // namespace
}  // namespace flowdlo
