// Real frames of one rope, where they lie beside the project: told apart, each stays one. A bar in
// front of a rope is what parts it first where ends come too cheap (path/energy.hpp).
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"
#include "support/source_dir.hpp"

namespace flowdlo {
namespace {

class RealRope : public ::testing::TestWithParam<const char*> {};

TEST_P(RealRope, IsOneWhereNobodySaysHowManyThereAre) {
  const auto folder = test::source_dir() / "../shared/data/real" / GetParam();
  if (!std::filesystem::exists(folder / "mask.png")) {
    GTEST_SKIP() << "no " << GetParam() << " beside the project";
  }
  const auto frame = load_frame_folder(folder);
  ASSERT_TRUE(frame) << frame.error().message;
  auto estimator = Estimator::create(
      {.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = "cpu", .quality = Quality::kFast, .ropes = 0});
  ASSERT_TRUE(estimator) << estimator.error().message;
  const auto ropes = estimator->estimate_ropes(frame->frame());
  ASSERT_TRUE(ropes) << ropes.error().message;
  ASSERT_EQ(ropes->ropes.size(), 1U);
  EXPECT_GT(ropes->ropes.front().confidence, 0.5F);
}

INSTANTIATE_TEST_SUITE_P(Mp2cdlo, RealRope,
                         ::testing::Values("mp2cdlo_0091", "mp2cdlo_0156", "mp2cdlo_0190",
                                           "mp2cdlo_0285", "mp2cdlo_0590"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace flowdlo
