// Memory: an estimator that is gone has given back what it took, the driver's part included.
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstddef>
#include <string>

#include "flowdlo/estimator.hpp"
#include "support/rose_frame.hpp"

namespace flowdlo {
namespace {

constexpr int kFirst = 3;  // times until drivers and the C library have what they keep
constexpr int kFurther = 6;
constexpr int kFirstFrames = 10;
constexpr int kFrames = 60;
/// Half of what OpenCV keeps for the two threads that a frame would start. Malloc itself sets aside
/// up to 20 kB, once, for threads that come to work late.
constexpr std::size_t kEachFrame_bytes = 1200;
constexpr std::size_t kEach_bytes = 16 * 1024;  // far below what any of an estimator's parts takes

/// All that is allocated and not freed, of every thread. Resident memory is no measure: the C
/// library keeps much of what was freed.
std::size_t in_use_bytes() {
  const auto heap = ::mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

class Memory : public ::testing::TestWithParam<const char*> {};

TEST_P(Memory, OfEstimatorsThatAreGoneIsFree) {
  if (in_use_bytes() == 0) GTEST_SKIP() << "another allocator is in place";
  const Config config{
      .weights = FLOWDLO_WEIGHTS, .device = GetParam(), .euler_steps = 1, .draws = 1};
  std::size_t before = 0;
  for (int i = 0; i < kFirst + kFurther; ++i) {
    if (i == kFirst) before = in_use_bytes();
    const auto made = Estimator::create(config);
    if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
    ASSERT_TRUE(made) << made.error().message;
  }
  EXPECT_LT(in_use_bytes(), before + kFurther * kEach_bytes);
}

/// Of a frame in doubt, whose readings run on threads: libraries keep data for every thread that
/// ever called them.
TEST_P(Memory, OfFramesThatAreDoneIsFree) {
  if (in_use_bytes() == 0) GTEST_SKIP() << "another allocator is in place";
  const testing::RoseFrame rose;
  auto made = Estimator::create({.weights = FLOWDLO_WEIGHTS,
                                 .device = GetParam(),
                                 .euler_steps = 1,
                                 .draws = 1,
                                 .gate = GateChoice::kCalibrated,
                                 .field = FieldChoice::kStrands,
                                 .field_weights = FLOWDLO_FIELD_WEIGHTS,
                                 .threads = 3});
  if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
  ASSERT_TRUE(made) << made.error().message;
  std::size_t before = 0;
  for (int i = 0; i < kFirstFrames + kFrames; ++i) {
    if (i == kFirstFrames) before = in_use_bytes();
    const auto estimate = made->estimate(rose.frame());
    ASSERT_TRUE(estimate) << estimate.error().message;
    ASSERT_GT(estimate->readings, 1);
  }
  EXPECT_LT(in_use_bytes(), before + kFrames * kEachFrame_bytes);
}

INSTANTIATE_TEST_SUITE_P(On, Memory, ::testing::Values("cpu", "vulkan"),
                         [](const auto& device) { return std::string(device.param); });

}  // namespace
}  // namespace flowdlo
