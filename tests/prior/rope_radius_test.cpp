#include "prior/rope_radius.hpp"

#include <gtest/gtest.h>

#include "prior/ends.hpp"
#include "prior/sheet.hpp"

namespace flowdlo::prior {
namespace {

using testing::kLevel;
using testing::Sheet;
using testing::strip_of;

TEST(MaskRadius, IsHalfTheWidthTimesTheDepth) {
  const Sheet sheet = Sheet().box(20, 115, 300, 125);
  const Strip strip = strip_of(kLevel, 11, sheet);
  const Extent whole{0, strip.stations.back().arclength_px};
  const auto background = background_m(strip);
  EXPECT_NEAR(mask_radius_m(strip, whole, background), 5.5 / 300 * 0.5 / (1 - 5.5 / 300), 3e-4);
}

}  // namespace
}  // namespace flowdlo::prior
