// A ring that is alone in its mask: it begins nowhere, whoever looks at it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "estimator/second_look.hpp"
#include "field/network.hpp"
#include "flowdlo/estimator.hpp"
#include "gathered.hpp"
#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"
#include "reference/program.hpp"
#include "support/ring_frame.hpp"
#include "support/wave_frame.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo {
namespace {

class Ring : public ::testing::Test {
 protected:
  static Estimator make() {
    auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = "cpu"});
    if (!estimator) throw std::runtime_error(estimator.error().message);
    return *std::move(estimator);
  }

  Estimate estimate(const Hints& hints = {}) {
    auto found = estimator_.estimate(ring_.frame(), hints);
    if (!found) throw std::runtime_error(found.error().message);
    return *std::move(found);
  }

  testing::RingFrame ring_;
  Estimator estimator_ = make();
};

/// As an estimate would have it that begins `by` nodes later and runs the other way round.
Centerline told_otherwise(const Centerline& nodes, std::size_t by) {
  constexpr std::size_t kSteps = kNodes - 1;  // the last node is the first
  Centerline other;
  for (std::size_t i = 0; i < kNodes; ++i) other[i] = nodes[(by + kSteps - i % kSteps) % kSteps];
  return other;
}

TEST_F(Ring, IsFoundClosedAndSaysHowSureItIs) {
  const Estimate found = estimate();
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(geometry::distance(found.nodes.front(), found.nodes.back()), 0);
  EXPECT_LT(geometry::mean_distance(ring_.truth, found.nodes, true), 0.0015);
  EXPECT_GT(found.confidence, 0.8F);
  auto sigma_m = found.sigma_m;
  std::sort(sigma_m.begin(), sigma_m.end());
  EXPECT_LT(sigma_m[kNodes / 2], 0.02F);
}

TEST_F(Ring, BeginsWhereItDidInTheFrameBefore) {
  const Estimate alone = estimate();
  for (const std::size_t by : {0, 17, 40}) {
    const Centerline before = told_otherwise(alone.nodes, by);
    const Estimate found = estimate({.previous = before});
    EXPECT_TRUE(found.closed);
    EXPECT_NE(found.origin, Origin::kFrameBefore);
    EXPECT_TRUE(found.reversed);
    for (std::size_t i = 0; i < kNodes; ++i) {
      EXPECT_LT(geometry::distance(found.nodes[i], before[i]), 0.003) << by << ", node " << i;
    }
    EXPECT_NEAR(found.confidence, alone.confidence, 1e-6F);
    EXPECT_TRUE(std::is_permutation(found.support.begin(), found.support.end(),
                                    alone.support.begin(), alone.support.end()));
  }
}

/// A bar of 24 px lies across it, 40 mm above the table.
void lay_a_bar_over(testing::RingFrame& ring) {
  for (int v = 0; v < testing::RingFrame::kHeight; ++v) {
    for (int u = 140; u < 164; ++u) {
      const auto pixel =
          static_cast<std::size_t>(v) * testing::RingFrame::kWidth + static_cast<std::size_t>(u);
      ring.mask[pixel] = 0;
      ring.depth_m[pixel] = testing::RingFrame::kTable_m - 0.04F;
      for (std::size_t c = 0; c < 3; ++c) ring.color_bgr[3 * pixel + c] = 160;
    }
  }
}

TEST_F(Ring, ThatABarPartsIsClosedWhereThatIsKnown) {
  lay_a_bar_over(ring_);
  EXPECT_FALSE(estimate().closed);
  const Estimate found = estimate({.closed = true});
  EXPECT_TRUE(found.closed);
  EXPECT_LT(geometry::mean_distance(ring_.truth, found.nodes, true), 0.003);
  EXPECT_EQ(geometry::distance(found.nodes.front(), found.nodes.back()), 0);
}

TEST_F(Ring, HasTwoEndsWhereThatIsKnown) { EXPECT_FALSE(estimate({.closed = false}).closed); }

TEST_F(Ring, IsNotBelievedToBeOneAgainstAllThatTheFrameShows) {
  const testing::WaveFrame wave;  // whose ends lie far apart in plain sight
  const auto plain = estimator_.estimate(wave.frame());
  const auto ring = estimator_.estimate(wave.frame(), {.closed = true});
  ASSERT_TRUE(plain && ring);
  EXPECT_GT(plain->confidence, 0.7F);
  EXPECT_LT(ring->confidence, 0.5F);
}

TEST_F(Ring, ThatIsKnownHasNoEnds) {
  const auto refused =
      estimator_.estimate(ring_.frame(), {.ends = {Pixel{10, 10}}, .closed = true});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(refused.error().message,
            "Hints.ends: expected none of a rope that Hints.closed says is a ring, got 1");
}

TEST_F(Ring, ThatTwoReadingsFindIsOneHypothesis) {
  const Frame frame = ring_.frame();
  auto weights = weights::load_field(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(weights) << weights.error().message;
  auto network =
      field::Network::create(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                             [] { return reference::create_program(1); });
  ASSERT_TRUE(network) << network.error().message;
  const auto conditions = testing::gathered(frame);
  ASSERT_TRUE(conditions.hypotheses.front().course.closed);
  threads::Pool pool(1);
  auto look = estimator::Rereading(pool, true, &*network, conditions, frame, {}).finish();
  EXPECT_EQ(look.readings, 2);
  ASSERT_EQ(look.hypotheses.size(), 1U);
  EXPECT_NEAR(look.hypotheses.front().votes, 1, 1e-5);
  EXPECT_NEAR(look.hypotheses.front().odds, 1, 1e-3);
}

}  // namespace
}  // namespace flowdlo
