#include "estimator/rope_confidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "gate/one_rope.hpp"
#include "path/path.hpp"

namespace flowdlo {
namespace {

using estimator::rope_confidence;
using estimator::ToldApart;
using estimator::Witness;

Estimate sure_of(float confidence) {
  Estimate rope;
  rope.confidence = confidence;
  return rope;
}

TEST(RopeConfidence, RisesWithWhatASetWithoutTheRopeWouldCost) {
  for (const Witness witness : {Witness::kNone, Witness::kAgrees, Witness::kDiffers}) {
    const float tie = rope_confidence({witness, 0}, sure_of(0.9F));
    const float some = rope_confidence({witness, 2}, sure_of(0.9F));
    const float most = rope_confidence({witness, path::kMostLead}, sure_of(0.9F));
    EXPECT_LT(tie, 0.65F);
    EXPECT_LT(tie, some);
    EXPECT_LT(some, most);
    EXPECT_GT(most, 0.7F);
  }
}

TEST(RopeConfidence, RisesWithTheEstimatesOwn) {
  for (const Witness witness :
       {Witness::kNone, Witness::kAgrees, Witness::kDiffers, Witness::kLabel}) {
    const ToldApart told{witness, path::kMostLead};
    EXPECT_LT(rope_confidence(told, sure_of(0.1F)), rope_confidence(told, sure_of(0.5F)));
    EXPECT_LT(rope_confidence(told, sure_of(0.5F)), rope_confidence(told, sure_of(0.98F)));
  }
}

TEST(RopeConfidence, IsHigherWhereTheMaskHasTheRopeAsWell) {
  for (const float lead : {0.0F, 2.0F, path::kMostLead}) {
    EXPECT_GT(rope_confidence({Witness::kAgrees, lead}, sure_of(0.9F)),
              rope_confidence({Witness::kDiffers, lead}, sure_of(0.9F)));
  }
  EXPECT_GT(rope_confidence({Witness::kAgrees, path::kMostLead}, sure_of(0.98F)), 0.97F);
}

TEST(RopeConfidence, OfALabelledRopeIsSurerThanItsEstimateKnows) {
  EXPECT_GT(rope_confidence({Witness::kLabel, 0}, sure_of(0.5F)), 0.7F);
}

TEST(RopeConfidence, OfARingDoesNotHeedAGateForRopesWithTwoEnds) {
  Estimate low = sure_of(0.001F);
  Estimate high = sure_of(0.99F);
  low.closed = high.closed = true;
  const ToldApart told{Witness::kAgrees, path::kMostLead};
  EXPECT_EQ(rope_confidence(told, low), rope_confidence(told, high));
  EXPECT_GT(rope_confidence(told, low), 0.8F);
}

TEST(RopeConfidence, IsLowWhereItsNodesLeaveADoubt) {
  Estimate rope = sure_of(0.98F);
  rope.one_rope.doubts = {Doubt::kStrandsLeft};
  EXPECT_LE(rope_confidence({Witness::kAgrees, path::kMostLead}, rope), gate::kDoubted);
}

TEST(RopeConfidence, IsAProbabilityAtBothBounds) {
  for (const float own : {0.0F, 1.0F}) {
    const float confidence = rope_confidence({Witness::kAgrees, path::kMostLead}, sure_of(own));
    EXPECT_GT(confidence, 0.0F);
    EXPECT_LT(confidence, 1.0F);
  }
}

}  // namespace
}  // namespace flowdlo
