#include "synth/dice.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace flowdlo::synth {
namespace {

SceneKey key(Split split, Part part, std::uint64_t seed, std::uint64_t index) {
  return {split, part, seed, index};
}

TEST(Dice, NoTwoStreamsOfOneSeedShareACounter) {
  std::set<std::pair<std::uint64_t, std::uint64_t>> seen;
  int streams = 0;
  for (const Split split : {Split::kThesis, Split::kWide}) {
    for (const Part part : {Part::kTraining, Part::kValidation}) {
      for (const std::uint64_t index : {0ULL, 1ULL, 2ULL, (1ULL << 40) - 1}) {
        for (const Use use : {Use::kScenario, Use::kRope, Use::kView, Use::kThings, Use::kSensor,
                              Use::kMask, Use::kLook}) {
          for (const int frame : {0, 1, 99}) {
            const SceneKey scene = key(split, part, 7, index);
            seen.emplace(Dice::stream_of(scene, use, frame), Dice::first_counter_of(scene));
            ++streams;
          }
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(streams));
}

TEST(Dice, PartsDifferInTheirStreamWhateverTheSeedsAndIndices) {
  for (const std::uint64_t seed : {0ULL, 1ULL, 12345ULL}) {
    const auto training =
        Dice::stream_of(key(Split::kWide, Part::kTraining, seed, 3), Use::kRope, 0);
    const auto validation =
        Dice::stream_of(key(Split::kWide, Part::kValidation, 99 - seed, 4), Use::kRope, 0);
    EXPECT_NE(training & 1U, validation & 1U);
  }
}

TEST(Dice, TheSameKeyGivesTheSameNumbers) {
  Dice first(key(Split::kWide, Part::kTraining, 5, 9), Use::kView);
  Dice second(key(Split::kWide, Part::kTraining, 5, 9), Use::kView);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first.word(), second.word());
}

TEST(Dice, IntegersReachBothLimitsAndNothingElse) {
  Dice dice(key(Split::kWide, Part::kTraining, 0, 0), Use::kRope);
  std::set<int> seen;
  for (int i = 0; i < 500; ++i) seen.insert(dice.integer(2, 5));
  EXPECT_EQ(seen, (std::set<int>{2, 3, 4, 5}));
}

TEST(Dice, PickFollowsTheWeights) {
  Dice dice(key(Split::kWide, Part::kTraining, 0, 1), Use::kRope);
  std::array<int, 3> counts{};
  for (int i = 0; i < 4000; ++i) ++counts[dice.pick({1, 0, 3})];
  EXPECT_EQ(counts[1], 0);
  EXPECT_NEAR(counts[0], 1000, 120);
}

}  // namespace
}  // namespace flowdlo::synth
