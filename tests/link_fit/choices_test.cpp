#include "link_fit/choices.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::lab {
namespace {

/// Strands 0 and 1 follow each other (ends 1 and 2), and a speck (ends 4 and 5) lies on no rope.
LinkSample two_and_a_speck() {
  LinkSample sample;
  sample.ends.resize(6);
  sample.ends[0].partner = kStops;
  sample.ends[1].partner = 2;
  sample.ends[2].partner = 1;
  sample.ends[3].partner = kStops;
  for (const auto& [a, b] : {std::pair(1, 2), {0, 3}, {1, 4}}) {
    sample.links.push_back({.a = a, .b = b});
  }
  return sample;
}

double cost_of(const std::vector<Change>& option, const std::vector<double>& costs) {
  double sum = 0;
  for (const Change& change : option) sum += change.sign * costs[change.thing];
  return sum;
}

TEST(Choices, AreWhatEachKnownEndMightDoElse) {
  const auto choices = choices_of(two_and_a_speck());
  ASSERT_EQ(choices.size(), 4U);  // of the speck's ends nothing is known
  // Stops cost 1, 2, 4, 8, 16 and 32; the links 100, 200 and 400.
  const std::vector<double> costs{1, 2, 4, 8, 16, 32, 100, 200, 400};
  const auto& first = choices[0].options;  // stops; might be linked to end 3, which stops as well
  ASSERT_EQ(first.size(), 2U);
  EXPECT_TRUE(first[0].empty());
  EXPECT_EQ(cost_of(first[1], costs), 200 - 1 - 8);
  const auto& linked = choices[1].options;  // goes on to 2; might stop, or go on to the speck
  ASSERT_EQ(linked.size(), 3U);
  EXPECT_EQ(cost_of(linked[1], costs), 2 + 4 - 100);
  EXPECT_EQ(cost_of(linked[2], costs), 400 - 100 + 4 + 32) << "the speck's other end stops";
}

TEST(Choices, TruthsAreOfStopsAndLinks) {
  const Truths truths = truths_of(two_and_a_speck());
  EXPECT_EQ(truths.known,
            (std::vector<bool>{true, true, true, true, false, false, true, true, true}));
  EXPECT_EQ(truths.there,
            (std::vector<bool>{true, false, false, true, false, false, true, false, false}));
}

TEST(Choices, AreJudgedByWhatTheyCost) {
  const auto choices = choices_of(two_and_a_speck());
  std::vector<double> costs{0, 5, 5, 0, 1, 1, 2, 9, 9};
  const Judged judged = judge(choices[1], costs, {});
  EXPECT_TRUE(judged.right);
  const double others = std::exp(-(10.0 - 2)) + std::exp(-(9.0 - 2 + 5 + 1));
  EXPECT_NEAR(judged.unlikely, std::log1p(others), 1e-12);
  costs[6] = 30;
  EXPECT_FALSE(judge(choices[1], costs, {}).right);
}

TEST(Choices, SlopesAreThoseOfDifferences) {
  const std::vector<double> costs{0.3, 1.5, 0.9, 0.2, 1.1, 0.7, 2.1, 1.4, 3.2};
  for (const EndChoice& choice : choices_of(two_and_a_speck())) {
    std::vector<double> slopes(costs.size(), 0);
    (void)judge(choice, costs, slopes);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      auto more = costs;
      auto less = costs;
      more[i] += 1e-5;
      less[i] -= 1e-5;
      const double slope =
          (judge(choice, more, {}).unlikely - judge(choice, less, {}).unlikely) / 2e-5;
      EXPECT_NEAR(slopes[i], slope, 1e-8) << i;
    }
  }
}

}  // namespace
}  // namespace flowdlo::lab
