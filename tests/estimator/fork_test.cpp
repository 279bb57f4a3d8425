// An estimator in a process that was forked from the one that made it.
#include <gtest/gtest.h>

#include <memory>

#include "flowdlo/estimator.hpp"
#include "support/forked.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::forked;
using testing::WaveFrame;

Config config(const char* device) {
  return {.weights = FLOWDLO_WEIGHTS, .device = device, .euler_steps = 1, .draws = 2, .threads = 3};
}

std::unique_ptr<Estimator> make(const char* device = "cpu") {
  auto made = Estimator::create(config(device));
  return made ? std::make_unique<Estimator>(*std::move(made)) : nullptr;
}

class Fork : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    estimator_ = make(GetParam());
    if (!estimator_) GTEST_SKIP() << "no device for \"" << GetParam() << '"';
    ASSERT_TRUE(estimator_->estimate(wave_.frame()));
  }

  WaveFrame wave_;
  std::unique_ptr<Estimator> estimator_;
};

TEST_P(Fork, AChildMayDestroyWhatItInherited) {
  EXPECT_EQ(forked([&] {
              estimator_.reset();
              return 0;
            }),
            0);
}

TEST_P(Fork, UsingWhatWasInheritedIsAnErrorThatSaysWhatToDo) {
  EXPECT_EQ(forked([&] {
              const auto estimate = estimator_->estimate(wave_.frame());
              if (estimate) return 1;
              const Error& error = estimate.error();
              if (error.message.find("make a new one") == std::string::npos) return 2;
              return error.code == ErrorCode::kDeviceLost ? 0 : 3;
            }),
            0);
}

TEST_P(Fork, TheParentsGoesOnAsBefore) {
  const auto before = estimator_->estimate(wave_.frame());
  ASSERT_EQ(forked([&] {
              estimator_.reset();
              return 0;
            }),
            0);
  const auto after = estimator_->estimate(wave_.frame());
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->nodes, after->nodes);
}

INSTANTIATE_TEST_SUITE_P(Devices, Fork, ::testing::Values("cpu", "vulkan"),
                         [](const auto& which) { return std::string(which.param); });

TEST(ForkedChild, MakesANewOneInPlaceOfTheInheritedAndGetsTheSameBits) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the thread sanitizer lets a forked process start no threads";
#endif
  const WaveFrame wave;
  auto estimator = make();
  ASSERT_NE(estimator, nullptr);
  const auto expected = estimator->estimate(wave.frame());
  ASSERT_TRUE(expected);
  EXPECT_EQ(forked([&] {
              auto made = Estimator::create(config("cpu"));
              if (!made) return 1;
              *estimator = *std::move(made);
              const auto estimate = estimator->estimate(wave.frame());
              if (!estimate) return 2;
              return estimate->nodes == expected->nodes ? 0 : 3;
            }),
            0);
}

}  // namespace
}  // namespace flowdlo
