#include "estimator/judge.hpp"

#include <gtest/gtest.h>

#include "gathered.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

/// A gate whose numbers are all nought gives everything a confidence of a half.
class UnsureGate : public ::testing::Test {
 protected:
  [[nodiscard]] estimator::Judge judge() const {
    return {&fitted_, hints_, conditions_, frame_, 0, nullptr};
  }

  testing::WaveFrame wave_;
  Frame frame_ = wave_.frame();
  estimator::Conditions conditions_ = testing::gathered(frame_);
  gate::Fitted fitted_;
  Hints hints_;
};

TEST_F(UnsureGate, EndsNoFrameWithWhatTheFieldSaysFirst) {
  conditions_.axes = field::Axes{};
  const auto first = judge().of_first(false);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_FALSE(*first);
}

TEST_F(UnsureGate, ReturnsARopeThatWasToldApartHoweverDoubtful) {
  const auto first = judge().of_first(true);
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_TRUE(*first);
  EXPECT_LT((*first)->confidence, estimator::kSure);
  EXPECT_EQ((*first)->look.readings, 1);
}

}  // namespace
}  // namespace flowdlo
