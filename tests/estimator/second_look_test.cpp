#include "estimator/second_look.hpp"

#include <gtest/gtest.h>

#include "gathered.hpp"
#include "path/limits.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

class LookAgain : public ::testing::Test {
 protected:
  [[nodiscard]] estimator::SecondLook look(int threads = 1) const {
    return estimator::look_again(conditions_, frame_, 0, weights::PriorKind::kRefined, threads);
  }
  /// A closed ring's ends are a guess: there is always doubt.
  void cast_doubt() { conditions_.hypotheses.front().evidence.ring = true; }
  /// As if the first reading had lost its way by that much.
  void lead_astray(float shift_m) {
    cast_doubt();
    conditions_.hypotheses.resize(1);
    for (Point3& node : conditions_.hypotheses.front().prior.nodes) node.y += shift_m;
  }

  testing::WaveFrame wave_;
  Frame frame_ = wave_.frame();
  estimator::Conditions conditions_ = testing::gathered(frame_);
};

TEST_F(LookAgain, AClearFrameIsReadOnce) {
  EXPECT_FALSE(estimator::in_doubt(conditions_));
  const auto once = look();
  EXPECT_EQ(once.readings, 1);
  ASSERT_EQ(once.hypotheses.size(), conditions_.hypotheses.size());
  EXPECT_EQ(once.hypotheses.front().votes, 1);
  EXPECT_GT(once.hypotheses.front().odds, 0.9F);
}

TEST_F(LookAgain, WhereThereIsDoubtOtherReadingsSayWhatTheyHold) {
  cast_doubt();
  EXPECT_TRUE(estimator::in_doubt(conditions_));
  const auto again = look();
  EXPECT_GE(again.readings, 4);
  EXPECT_NEAR(again.hypotheses.front().votes, 1, 1e-5);
  EXPECT_GT(again.hypotheses.front().odds, 0.9F);
  EXPECT_EQ(again.hypotheses.front().reading, 0);
  for (std::size_t h = 1; h < again.hypotheses.size(); ++h) {
    EXPECT_EQ(again.hypotheses[h].votes, 0);
    EXPECT_LT(again.hypotheses[h].odds, 0.1F);
  }
}

TEST_F(LookAgain, ATangleIsReadOnceHoweverDoubtful) {
  cast_doubt();
  conditions_.paths.strands = path::kMostRereadStrands + 1;
  EXPECT_FALSE(estimator::in_doubt(conditions_));
  EXPECT_EQ(look().readings, 1);
}

TEST_F(LookAgain, WhatTheFirstReadingMissedComesBehindWithTheVotesOfTheOthers) {
  const auto right = conditions_.hypotheses.front().prior.nodes;
  lead_astray(0.2F);
  const auto again = look();
  ASSERT_GE(again.hypotheses.size(), 2U);
  const auto others = static_cast<float>(again.readings - 1);
  EXPECT_NEAR(again.hypotheses[0].votes, 1 / (others + 1), 1e-5);
  EXPECT_NEAR(again.hypotheses[1].votes, others / (others + 1), 1e-5);
  EXPECT_GT(again.hypotheses[1].reading, 0);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR(again.hypotheses[1].prior.nodes[i].y, right[i].y, 0.01F);
  }
}

TEST_F(LookAgain, NumberOfThreadsChangesNothing) {
  lead_astray(0.2F);
  const auto one = look(1);
  const auto four = look(4);
  ASSERT_EQ(one.hypotheses.size(), four.hypotheses.size());
  for (std::size_t h = 0; h < one.hypotheses.size(); ++h) {
    EXPECT_EQ(one.hypotheses[h].votes, four.hypotheses[h].votes);
    EXPECT_EQ(one.hypotheses[h].odds, four.hypotheses[h].odds);
    EXPECT_EQ(one.hypotheses[h].prior.nodes[9].x, four.hypotheses[h].prior.nodes[9].x);
  }
}

}  // namespace
}  // namespace flowdlo
