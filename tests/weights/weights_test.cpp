#include "weights/weights.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace flowdlo::weights {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Weights, AtFindsATensorByName) {
  const auto weights = seeded({}, 1);
  EXPECT_EQ(weights.at("encoder.5.down.bias").shape, std::vector<int>{256});
}

TEST(Faults, MissingTensorIsNamed) {
  auto weights = seeded({}, 1);
  weights.tensors.pop_back();
  EXPECT_THAT(faults(weights), ElementsAre(AllOf(HasSubstr("\"head.bias\""), HasSubstr("none"))));
}

TEST(Faults, UnknownTensorIsNamed) {
  auto weights = seeded({}, 1);
  weights.tensors.push_back({"surplus", {2}, {1, 2}});
  EXPECT_THAT(faults(weights), ElementsAre(HasSubstr("\"surplus\"")));
}

TEST(Faults, WrongShapeIsTold) {
  auto weights = seeded({}, 1);
  weights.tensors.front().shape = {3, 256};
  EXPECT_THAT(faults(weights),
              ElementsAre(AllOf(HasSubstr("expected [256, 3]"), HasSubstr("got [3, 256]"))));
}

TEST(Faults, TooFewValuesAreTold) {
  auto weights = seeded({}, 1);
  weights.tensors.front().values.pop_back();
  EXPECT_THAT(faults(weights), ElementsAre(HasSubstr("expected 3072 bytes")));
}

TEST(Faults, ValuesThatAreNotFiniteAreCounted) {
  auto weights = seeded({}, 1);
  weights.tensors[2].values[5] = std::numeric_limits<float>::quiet_NaN();
  weights.tensors[2].values[9] = -std::numeric_limits<float>::infinity();
  EXPECT_THAT(faults(weights), ElementsAre(AllOf(HasSubstr("got 2"), HasSubstr("the first at 5"))));
}

TEST(Faults, AnotherOrderThanTheManifestsIsTold) {
  auto weights = seeded({}, 1);
  std::swap(weights.tensors[0], weights.tensors[1]);
  EXPECT_EQ(faults(weights).size(), 2U);
}

}  // namespace
}  // namespace flowdlo::weights
