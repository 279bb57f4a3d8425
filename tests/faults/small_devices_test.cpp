// Devices that can little, by what they say of themselves: lavapipe's answers are clamped on their
// way to the engine, and the validation layers hold the engine to the clamped ones. A subgroup of
// another size cannot be had there: where one is said, there are no shuffles either.
#include <gmock/gmock.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "faults/relayed.hpp"
#include "flowdlo/devices.hpp"
#include "flowdlo/estimator.hpp"
#include "support/wave_frame.hpp"
#include "vulkan/every_op.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/vulkan_api.hpp"

namespace flowdlo::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Small {
  const char* like;
  RelayLimits limits;
  std::vector<const char*> gemms;  ///< any of them; empty: as it comes
};

/// Least values of the specification: 16 KB, 128 invocations, 128 bytes, 65,536 texels, 4 buffers.
const std::vector<Small>& small_devices() {
  static const std::vector<Small> all = {
      {"the least that Vulkan 1.1 allows",
       {.shuffles = false,
        .size_control = false,
        .subgroup_size = 1,
        .shared_bytes = 16384,
        .invocations = 128,
        .push_bytes = 128,
        .texels = 65536,
        .storage_buffers = 4,
        .api_version = VK_API_VERSION_1_1},
       {"tile 32 x 32 x 16", "tile 32 x 64 x 16"}},
      {"16 lanes, no shuffles, as a Raspberry Pi 4",
       {.shuffles = false,
        .size_control = false,
        .subgroup_size = 16,
        .shared_bytes = 16384,
        .invocations = 256,
        .push_bytes = 128,
        .api_version = VK_API_VERSION_1_1},
       {"tile"}},
      {"64 lanes, no shuffles, as a wide GPU",
       {.shuffles = false,
        .size_control = false,
        .subgroup_size = 64,
        .shared_bytes = 32768,
        .invocations = 1024,
        .push_bytes = 128},
       {"tile"}},
      {"128 lanes, no shuffles",
       {.shuffles = false, .size_control = false, .subgroup_size = 128},
       {"tile"}},
      {"memory of its own, as a card in a slot", {.memory_apart = true}, {}},
      {"shuffles and 16 KB, as a small Mali",
       {.size_control = false,
        .shared_bytes = 16384,
        .invocations = 384,
        .push_bytes = 128,
        .texels = 65536},
       {}},
  };
  return all;
}

std::string names_of(const std::vector<const char*>& gemms) {
  std::string text;
  for (const char* const gemm : gemms) text += std::string(text.empty() ? "" : ", ") + gemm;
  return text;
}

class SmallDevices : public Relayed {
 protected:
  WaveFrame wave_{160, 120, 7.0F};
};

/// Every operation against its twin on the CPU, and the layers have nothing to say.
TEST_F(SmallDevices, RunEveryOperationWithinTheirLimits) {
  const auto expected = vulkan::testing::run_on_cpu(vulkan::testing::record_every_op);
  for (const bool as_gpu : {false, true}) {
    relay()->pose_as_gpu(as_gpu);
    for (const auto& [like, limits, gemms] : small_devices()) {
      SCOPED_TRACE(std::string(like) + (as_gpu ? ", as a GPU" : ", as a CPU driver"));
      relay()->limit(limits);
      vulkan::forget_findings();
      const auto device =
          vulkan::open_device({.wanted = "vulkan", .validation = true, .probing = {.on = false}});
      ASSERT_TRUE(device) << device.error().message;
      EXPECT_EQ(vulkan::report(**device).shuffles, limits.shuffles);
      const auto got = vulkan::testing::run_on(*device, vulkan::testing::record_every_op);
      ASSERT_EQ(got.size(), expected.size());
      for (std::size_t i = 0; i < got.size(); ++i) {
        vulkan::testing::expect_near(expected[i], got[i], 1e-4F);
      }
      const std::string chosen = vulkan::gemm_name(**device);
      bool known = gemms.empty();
      for (const char* const gemm : gemms) known = known || chosen.find(gemm) == 0;
      EXPECT_TRUE(known) << "expected one of " << names_of(gemms) << ", got " << chosen;
      EXPECT_THAT(vulkan::validation_messages(**device), IsEmpty());
    }
  }
}

/// The smallest and the largest: lavapipe takes 3 s to compile a GPU's kernels. FLOWDLO_LONG_TESTS
/// asks them all.
TEST_F(SmallDevices, AreTakenByAutoOnceTheirSelfTestPasses) {
  relay()->pose_as_gpu(true);
  const bool thorough = std::getenv("FLOWDLO_LONG_TESTS") != nullptr;
  for (const auto& [like, limits, gemms] : small_devices()) {
    if (!thorough && like != small_devices().front().like && like != small_devices().back().like) {
      continue;
    }
    SCOPED_TRACE(like);
    relay()->limit(limits);
    const DeviceSurvey survey = survey_devices(/*self_test=*/true, /*probe=*/false);
    ASSERT_EQ(survey.vulkan.size(), 1U);
    EXPECT_THAT(survey.vulkan[0].lacks, IsEmpty());
    EXPECT_TRUE(survey.vulkan[0].self_test_passed) << survey.vulkan[0].self_test;
    EXPECT_EQ(survey.auto_choice, "Relayed GPU");
  }
  auto made = Estimator::create({.weights = FLOWDLO_WEIGHTS, .euler_steps = 2, .draws = 1});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->device(), "Relayed GPU");
  EXPECT_TRUE(made->estimate(wave_.frame()));
}

/// As MoltenVK's: the loader hides such a driver, and the device must be made with its extension.
TEST_F(SmallDevices, WithASubsetOfVulkanAreAskedForAndOpened) {
  const test::Drivers portable(FLOWDLO_RELAY_PORTABILITY);
  relay()->limit({.portability = true});
  const DeviceSurvey survey = survey_devices(/*self_test=*/true, /*probe=*/false);
  ASSERT_EQ(survey.vulkan.size(), 1U) << survey.advice;
  EXPECT_TRUE(survey.vulkan[0].self_test_passed) << survey.vulkan[0].self_test;
  const auto device =
      vulkan::open_device({.wanted = "vulkan", .validation = true, .probing = {.on = false}});
  ASSERT_TRUE(device) << device.error().message;
  const auto expected = vulkan::testing::run_on_cpu(vulkan::testing::record_every_op);
  const auto got = vulkan::testing::run_on(*device, vulkan::testing::record_every_op);
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    vulkan::testing::expect_near(expected[i], got[i], 1e-4F);
  }
  EXPECT_THAT(vulkan::validation_messages(**device), IsEmpty());
}

/// What cannot be run here is at least chosen: lanes of devices that let us choose, or do not.
TEST_F(SmallDevices, GetTheirLanes) {
  relay()->pose_as_gpu(true);
  struct Lanes {
    const char* like;
    RelayLimits limits;
    int expected;
  };
  for (const auto& [like, limits, expected] :
       {Lanes{"8, 16 or 32, as Intel's", {.least_lanes = 8, .most_lanes = 32}, 32},
        Lanes{"8 or 16", {.least_lanes = 8, .most_lanes = 16}, 16},
        Lanes{"64 alone", {.least_lanes = 64, .most_lanes = 64}, 64},
        Lanes{"32, no choice, as an older NVIDIA's",
              {.size_control = false, .subgroup_size = 32},
              32}}) {
    SCOPED_TRACE(like);
    relay()->limit(limits);
    const DeviceSurvey survey = survey_devices(/*self_test=*/false, /*probe=*/false);
    ASSERT_EQ(survey.vulkan.size(), 1U);
    EXPECT_THAT(survey.vulkan[0].lacks, IsEmpty());
    EXPECT_TRUE(survey.vulkan[0].shuffles);
    EXPECT_EQ(survey.vulkan[0].subgroup_size, expected);
  }
}

TEST_F(SmallDevices, ThatLackSomethingAreNamedWithItAndAutoTakesTheCpu) {
  relay()->pose_as_gpu(true);
  const std::vector<std::pair<RelayLimits, std::string>> lacking = {
      {{.float_texels = false}, "uniform texel buffers of RGBA32F"},
      {{.api_version = VK_API_VERSION_1_0}, "Vulkan 1.1 (has 1.0.0)"},
      {{.size_control = false, .subgroup_size = 2}, "a subgroup of 4 to 128 lanes (has 2)"}};
  for (const auto& [limits, what] : lacking) {
    SCOPED_TRACE(what);
    relay()->limit(limits);
    const DeviceSurvey survey = survey_devices(/*self_test=*/true, /*probe=*/false);
    ASSERT_EQ(survey.vulkan.size(), 1U);
    EXPECT_THAT(survey.vulkan[0].lacks, ElementsAre(what));
    EXPECT_FALSE(survey.vulkan[0].self_test_run);
    EXPECT_EQ(survey.auto_choice, "cpu");
    EXPECT_THAT(survey.advice, HasSubstr("\"Relayed GPU\": lacks " + what));
    auto made = Estimator::create({.weights = FLOWDLO_WEIGHTS, .euler_steps = 1, .draws = 1});
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->device(), "cpu");
  }
}

}  // namespace
}  // namespace flowdlo::testing
