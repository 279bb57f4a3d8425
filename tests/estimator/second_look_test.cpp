#include "estimator/second_look.hpp"

#include <gtest/gtest.h>

#include "gathered.hpp"
#include "path/limits.hpp"
#include "reference/program.hpp"
#include "support/wave_frame.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo {
namespace {

class LookAgain : public ::testing::Test {
 protected:
  /// As a `doubtful` frame is read again, by the shipped network and by the mask.
  [[nodiscard]] estimator::SecondLook look(bool doubtful, int threads = 1) const {
    auto weights = weights::load_field(FLOWDLO_FIELD_WEIGHTS);
    if (!weights) throw std::runtime_error(weights.error().message);
    auto network =
        field::Network::create(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                               [] { return reference::create_program(1); });
    threads::Pool pool(threads);
    return estimator::Rereading(pool, doubtful, &*network, conditions_, frame_, {}).finish();
  }
  [[nodiscard]] bool worth_rereading() const {
    return estimator::worth_rereading(conditions_, frame_);
  }
  /// As if the first reading had lost its way by that much, half way along the rope.
  void lead_astray(float shift_m) {
    conditions_.hypotheses.resize(1);
    auto& nodes = conditions_.hypotheses.front().prior.nodes;
    for (std::size_t i = kNodes / 2; i < kNodes; ++i) nodes[i].y += shift_m;
  }

  void give_picture() {
    picture_.assign(
        3 * static_cast<std::size_t>(frame_.width) * static_cast<std::size_t>(frame_.height), 90);
    frame_.color_bgr = picture_;
  }

  testing::WaveFrame wave_;
  std::vector<std::uint8_t> picture_;
  Frame frame_ = wave_.frame();
  estimator::Conditions conditions_ = testing::gathered(frame_);
};

TEST_F(LookAgain, HoweverClearAFrameIsOtherReadingsSayWhatTheyHold) {
  EXPECT_TRUE(worth_rereading());
  const auto again = look(true);
  EXPECT_EQ(again.readings, 2) << "the mask was the first reading";
  EXPECT_NEAR(again.hypotheses.front().votes, 1, 1e-5);
  EXPECT_GT(again.hypotheses.front().odds, 0.9F);
  EXPECT_GT(again.hypotheses.front().seen_odds, 0.9F);
  EXPECT_EQ(again.hypotheses.front().reading, 0);
  for (std::size_t h = 1; h < again.hypotheses.size(); ++h) {
    EXPECT_EQ(again.hypotheses[h].votes, 0);
    EXPECT_LT(again.hypotheses[h].odds, 0.1F);
  }
}

TEST_F(LookAgain, AFrameWithoutDoubtIsReadOnce) { EXPECT_EQ(look(false).readings, 1); }

TEST_F(LookAgain, OfATangleThatTheFieldSawTheMaskIsReadAllTheSame) {
  conditions_.paths.strands = path::kMostRereadStrands + 1;
  conditions_.of_mask = false;
  EXPECT_EQ(look(true).readings, 2);
}

TEST_F(LookAgain, WithoutAFieldTheMaskIsAllThereIs) {
  threads::Pool pool(1);
  const auto alone = estimator::Rereading(pool, true, nullptr, conditions_, frame_, {}).finish();
  EXPECT_EQ(alone.readings, 1);
  EXPECT_FALSE(alone.left_out);
}

TEST_F(LookAgain, TheFirstReadingAloneIsOfOneMind) {
  const auto first = estimator::first_look(conditions_, frame_);
  EXPECT_EQ(first.readings, 1);
  ASSERT_EQ(first.hypotheses.size(), conditions_.hypotheses.size());
  EXPECT_EQ(first.hypotheses.front().votes, 1);
  EXPECT_EQ(first.hypotheses.front().seen_odds, 0) << "the field was not asked";
  conditions_.axes = field::Axes{};  // as if these paths ran along it
  EXPECT_GT(estimator::first_look(conditions_, frame_).hypotheses.front().seen_odds, 0.9F);
}

TEST_F(LookAgain, ATangleIsReadOnce) {
  conditions_.paths.strands = path::kMostRereadStrands + 1;
  EXPECT_FALSE(worth_rereading());
  EXPECT_EQ(look(true).readings, 1);
}

TEST_F(LookAgain, WhereThereIsAPictureTheFieldLooksCloserAndTheMaskIsNotRead) {
  conditions_.of_mask = false;
  EXPECT_EQ(look(true).readings, 3) << "without a picture both";
  give_picture();
  EXPECT_EQ(look(true).readings, 2);
  conditions_.paths.strands = path::kMostRereadStrands + 1;
  EXPECT_EQ(look(true).readings, 2) << "of a tangle the mask, for the field does not look closer";
}

TEST_F(LookAgain, WhereTheFieldCannotLookCloserTheMaskIsReadInItsPlace) {
  conditions_.of_mask = false;
  give_picture();
  conditions_.axes = field::Axes{};
  conditions_.axes->magnified_for_px = estimator::kCloser * conditions_.paths.rope_width_px;
  const auto again = look(true);
  EXPECT_EQ(again.readings, 2);
  EXPECT_TRUE(again.axes->lines.empty()) << "of the first look";
}

TEST_F(LookAgain, WhatHasNoRopesShapeIsReadOnce) {
  auto& nodes = conditions_.hypotheses.front().prior.nodes;
  for (std::size_t i = 0; i < kNodes; ++i) nodes[i] = nodes[i / 16];  // a stub
  EXPECT_FALSE(worth_rereading());
}

TEST_F(LookAgain, WhatTheFirstReadingMissedComesBehindWithTheVotesOfTheOthers) {
  const auto right = conditions_.hypotheses.front().prior.nodes;
  lead_astray(0.2F);
  conditions_.of_mask = false;  // as if its paths had been known
  const auto again = look(true);
  ASSERT_EQ(again.readings, 3);
  ASSERT_GE(again.hypotheses.size(), 2U);
  EXPECT_NEAR(again.hypotheses[0].votes, 1 / 3.0F, 1e-5);
  EXPECT_NEAR(again.hypotheses[1].votes, 2 / 3.0F, 1e-5);
  EXPECT_GT(again.hypotheses[1].reading, 0);
  EXPECT_GT(again.hypotheses[1].seen_odds, 0.9F);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR(again.hypotheses[1].prior.nodes[i].y, right[i].y, 0.01F);
  }
}

TEST_F(LookAgain, NumberOfThreadsChangesNothing) {
  lead_astray(0.2F);
  conditions_.of_mask = false;
  const auto one = look(true, 1);
  const auto four = look(true, 4);
  ASSERT_EQ(one.hypotheses.size(), four.hypotheses.size());
  for (std::size_t h = 0; h < one.hypotheses.size(); ++h) {
    EXPECT_EQ(one.hypotheses[h].votes, four.hypotheses[h].votes);
    EXPECT_EQ(one.hypotheses[h].odds, four.hypotheses[h].odds);
    for (std::size_t i = 0; i < kNodes; ++i) {
      EXPECT_EQ(one.hypotheses[h].prior.nodes[i].x, four.hypotheses[h].prior.nodes[i].x);
    }
  }
}

}  // namespace
}  // namespace flowdlo
