// What an estimator on a Vulkan device does when our memory runs out: an Error or the right bits.
// The driver's own allocations are spared.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <optional>

#include "flowdlo/devices.hpp"
#include "flowdlo/estimator.hpp"
#include "frame/temporary_folder.hpp"
#include "memory/sweep.hpp"
#include "support/estimate_bits.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {
namespace {

constexpr Depth kShort = {4, 6};  // each call opens a device

Config vulkan() {
  return {.weights = FLOWDLO_WEIGHTS,
          .device = "vulkan",
          .euler_steps = 1,
          .draws = 1,
          .threads = 2,
          .max_width = 160,
          .max_height = 120};
}

class VulkanMemory : public ::testing::Test {
 protected:
  static void TearDownTestSuite() { cache_.reset(); }

  void SetUp() override {
    if (!cache_) cache_ = std::make_unique<test::TemporaryFolder>();
    ::setenv("XDG_CACHE_HOME", cache_->path().c_str(), 1);
    auto made = Estimator::create(vulkan());  // the first fills the cache
    if (!made) GTEST_SKIP() << made.error().message;
    estimator_.emplace(*std::move(made));
  }

  static inline std::unique_ptr<test::TemporaryFolder> cache_;
  WaveFrame wave_{160, 120, 7.0F};
  std::optional<Estimator> estimator_;
};

TEST_F(VulkanMemory, EstimateSurvivesEveryAllocation) {
  sweep(
      "Estimator::estimate on Vulkan", [&] { return estimator_->estimate(wave_.frame()); },
      [](const Result<Estimate>& estimate) { return bits_of(*estimate); });
}

TEST_F(VulkanMemory, CreateSurvivesEveryAllocation) {
  const Config config = vulkan();
  sweep(
      "Estimator::create on Vulkan", [&] { return Estimator::create(config); },
      [&](Result<Estimator>& made) { return bits_of(*made->estimate(wave_.frame())); }, kShort);
}

TEST_F(VulkanMemory, DestroyingNeedsNone) {
  const FailingAllocation failing(Fails::kFromOn, 1);
  estimator_.reset();
}

/// A survey never fails: one that found no memory says so in place of the loader's version.
Result<DeviceSurvey> surveyed(bool self_test) {
  DeviceSurvey survey = survey_devices(self_test);
  const bool lacked = survey.loader.find("memory") != std::string::npos;
  if (lacked && survey.auto_choice == "cpu") return Error{ErrorCode::kOutOfMemory, {}};
  return survey;
}

TEST_F(VulkanMemory, SurveySurvivesEveryAllocation) {
  const auto bits = [](const Result<DeviceSurvey>& survey) {
    std::string text = survey->loader + survey->auto_choice;
    for (const DeviceReport& report : survey->vulkan) {
      text += report.name + report.uuid + report.self_test;
    }
    return text;
  };
  sweep(
      "survey_devices", [] { return surveyed(false); }, bits, kShort);
  sweep("survey_devices with self-test", [] { return surveyed(true); }, bits, {1, 2});
}

}  // namespace
}  // namespace flowdlo::testing
