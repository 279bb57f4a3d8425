// The corpus is what its names say, and the same each time.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "hostile/hostile_frame.hpp"
#include "hostile/hostile_mask.hpp"

namespace flowdlo::lab {
namespace {

TEST(HostileCorpus, HasTwoHundredMasksOfFiveSizesAndNoNameTwice) {
  std::set<std::string> names;
  for (const HostileMask& mask : hostile_corpus()) names.insert(mask.name());
  EXPECT_EQ(hostile_corpus().size(), 200U);
  EXPECT_EQ(names.size(), 200U);
  EXPECT_EQ(hostile_sizes().front(), cv::Size(64, 64));
  EXPECT_EQ(hostile_sizes().back(), cv::Size(4096, 4096));
}

TEST(HostileCorpus, MasksAreDrawnAlikeEachTimeAndNoneIsEmpty) {
  std::set<std::string> different;
  std::size_t drawn = 0;
  for (const HostileMask& mask : hostile_corpus()) {
    if (mask.size_px != cv::Size(640, 480)) continue;
    const cv::Mat image = draw(mask);
    EXPECT_EQ(cv::countNonZero(image != draw(mask)), 0) << mask.name();
    EXPECT_GT(cv::countNonZero(image), 0) << mask.name();
    different.emplace(image.begin<std::uint8_t>(), image.end<std::uint8_t>());
    ++drawn;
  }
  EXPECT_EQ(different.size(), drawn) << "two patterns are one";
}

TEST(HostileFrame, IsValidAndLacksSomeDepths) {
  const auto frame = frame_around(draw_ordinary({320, 240}), "ordinary");
  ASSERT_TRUE(validate(frame.frame()));
  const auto missing = std::count(frame.depth_m.begin(), frame.depth_m.end(), 0.0F);
  EXPECT_NEAR(static_cast<double>(missing), 320 * 240 / 32.0, 320 * 240 / 100.0);
}

}  // namespace
}  // namespace flowdlo::lab
