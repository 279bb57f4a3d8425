// Estimators side by side, one a thread, on every back end. ThreadSanitizer watches: a race fails
// the test although the bits are right.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "flowdlo/estimator.hpp"
#include "support/estimate_bits.hpp"
#include "support/rose_frame.hpp"

namespace flowdlo {
namespace {

using testing::bits_of;
using testing::EstimateBits;
using testing::RoseFrame;

constexpr int kEstimators = 8;
constexpr int kFrames = 2;  // that each sees

/// A crew of two and further readings aside, no strand field.
Config busy(const std::string& device) {
  return {.weights = FLOWDLO_WEIGHTS,
          .device = device,
          .euler_steps = 1,
          .draws = 1,
          .gate = GateChoice::kCalibrated,
          .threads = 2,
          .device_timeout_ms = 600000};  // a watched driver compiles slowly
}

Estimator make(const Config& config) {
  auto estimator = Estimator::create(config);
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

/// work(i) on a thread of its own each, all at once; what they throw fails the test.
void side_by_side(int count, const std::function<void(int)>& work) {
  std::vector<std::string> faults(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] {
      try {
        work(i);
      } catch (const std::exception& thrown) {
        faults[static_cast<std::size_t>(i)] = thrown.what();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& fault : faults) EXPECT_EQ(fault, "");
}

/// Made, used and destroyed side by side.
void expect_the_bits_of_one_alone(const Config& config) {
  const RoseFrame rose;
  const EstimateBits alone = [&] {
    auto estimator = make(config);
    return bits_of(estimator, rose.frame());
  }();
  std::vector<int> same(kEstimators, 0);
  side_by_side(kEstimators, [&](int i) {
    auto estimator = make(config);
    for (int frame = 0; frame < kFrames; ++frame) {
      same[static_cast<std::size_t>(i)] += bits_of(estimator, rose.frame()) == alone ? 1 : 0;
    }
  });
  for (const int frames : same) EXPECT_EQ(frames, kFrames);
}

TEST(EightEstimators, OneAThreadOnTheCpuGiveTheBitsOfOneAlone) {
  expect_the_bits_of_one_alone(busy("cpu"));
}

/// An empty folder for compiled pipelines, which all estimators write at the same time.
class EmptyCache {
 public:
  EmptyCache() {
    std::filesystem::remove_all(folder_);
    ::setenv("XDG_CACHE_HOME", folder_.c_str(), /*overwrite=*/1);
  }
  ~EmptyCache() { std::filesystem::remove_all(folder_); }
  EmptyCache(const EmptyCache&) = delete;
  EmptyCache& operator=(const EmptyCache&) = delete;

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("flowdlo_races_" + std::to_string(::getpid()));
};

TEST(EightEstimators, OneAThreadOnVulkanGiveTheBitsOfOneAlone) {
  const EmptyCache cache;
  const auto first = Estimator::create(busy("vulkan"));
  if (!first && first.error().code == ErrorCode::kNoDevice) {
    GTEST_SKIP() << first.error().message;
  }
  ASSERT_TRUE(first) << first.error().message;
  expect_the_bits_of_one_alone(busy("vulkan"));
}

/// The strand field is asked on a thread beside the crew's: all that an estimator ever starts.
TEST(OneEstimator, AsksTheStrandFieldBesideTheModel) {
  const RoseFrame rose;
  Config config = busy("cpu");
  config.field_weights = FLOWDLO_FIELD_WEIGHTS;
  auto estimator = make(config);
  const EstimateBits before = bits_of(estimator, rose.frame());
  const auto estimate = estimator.estimate(rose.frame());
  ASSERT_TRUE(estimate) << estimate.error().message;
  EXPECT_GT(estimate->readings, 1) << "the field is asked where there is doubt";
  EXPECT_EQ(bits_of(estimator, rose.frame()), before);
}

TEST(OneEstimator, GoesFromThreadToThread) {
  const RoseFrame rose;
  std::optional<Estimator> estimator;
  std::optional<EstimateBits> before;
  side_by_side(1, [&](int) { estimator = make(busy("cpu")); });
  side_by_side(1, [&](int) { before = bits_of(*estimator, rose.frame()); });
  side_by_side(1, [&](int) { EXPECT_EQ(bits_of(*estimator, rose.frame()), *before); });
  side_by_side(1, [&](int) { estimator.reset(); });
}

}  // namespace
}  // namespace flowdlo
