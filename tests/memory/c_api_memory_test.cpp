// What the C interface does when memory runs out: a status with a message or the right bits, and no
// harm to the next call.
#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flowdlo/flowdlo.h"
#include "frame/temporary_folder.hpp"
#include "memory/sweep.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {
namespace {

Error last(flowdlo_status status) {
  return {static_cast<ErrorCode>(status - 1), flowdlo_last_error()};
}

struct Destroy {
  void operator()(flowdlo_estimator* estimator) const { flowdlo_estimator_destroy(estimator); }
  void operator()(flowdlo_frame_folder* folder) const { flowdlo_frame_folder_destroy(folder); }
};
using Handle = std::unique_ptr<flowdlo_estimator, Destroy>;
using Folder = std::unique_ptr<flowdlo_frame_folder, Destroy>;

Result<Handle> create() {
  flowdlo_config config;
  if (const auto status = flowdlo_config_init(&config, sizeof(config))) return last(status);
  config.weights = FLOWDLO_WEIGHTS;
  config.device = "cpu";
  config.euler_steps = 1;
  config.draws = 2;
  config.threads = 2;
  config.max_width = 160;
  config.max_height = 120;
  flowdlo_estimator* estimator = nullptr;
  if (const auto status = flowdlo_estimator_create(&config, &estimator)) return last(status);
  return Handle(estimator);
}

/// A wave whose depth has to be converted.
struct UnitsFrame {
  WaveFrame wave{160, 120, 7.0F};
  std::vector<std::uint16_t> units;

  UnitsFrame() {
    for (const float depth_m : wave.depth_m) {
      units.push_back(static_cast<std::uint16_t>(depth_m * 1000));
    }
  }

  [[nodiscard]] Result<flowdlo_estimate> estimate(flowdlo_estimator* estimator) const {
    flowdlo_frame frame;
    flowdlo_estimate out;
    if (const auto status = flowdlo_frame_init(&frame, sizeof(frame))) return last(status);
    if (const auto status = flowdlo_estimate_init(&out, sizeof(out))) return last(status);
    frame.depth = {units.data(), 0, 0, FLOWDLO_PIXEL_U16, 0};
    frame.mask = {wave.mask.data(), 0, 0, FLOWDLO_PIXEL_U8, 0};
    frame.width = wave.width;
    frame.height = wave.height;
    frame.fx = wave.camera.fx;
    frame.fy = wave.camera.fy;
    frame.cx = wave.camera.cx;
    frame.cy = wave.camera.cy;
    if (const auto status = flowdlo_estimator_estimate(estimator, &frame, &out)) {
      return last(status);
    }
    return out;
  }
};

std::string bits_of_c(const Result<flowdlo_estimate>& estimate) {
  flowdlo_estimate untimed = *estimate;
  constexpr auto kFirst = offsetof(flowdlo_estimate, evidence_ms);
  return {reinterpret_cast<const char*>(&untimed), kFirst};
}

TEST(CApiMemory, CreateAndTheFirstEstimateSurviveEveryAllocation) {
  const UnitsFrame frame;
  sweep("flowdlo_estimator_create", create,
        [&](Result<Handle>& made) { return bits_of_c(frame.estimate(made->get())); }, {12, 12});
}

TEST(CApiMemory, EstimateSurvivesEveryAllocation) {
  const UnitsFrame frame;
  const auto estimator = create();
  ASSERT_TRUE(estimator);
  sweep(
      "flowdlo_estimator_estimate", [&] { return frame.estimate(estimator->get()); }, bits_of_c);
}

TEST(CApiMemory, LoadingAFrameSurvivesEveryAllocation) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_frame(folder.path()).string();
  sweep(
      "flowdlo_frame_folder_load",
      [&]() -> Result<Folder> {
        flowdlo_frame_folder* loaded = nullptr;
        if (const auto status = flowdlo_frame_folder_load(path.c_str(), &loaded)) {
          return last(status);
        }
        return Folder(loaded);
      },
      [](Result<Folder>& loaded) {
        flowdlo_frame frame;
        EXPECT_EQ(flowdlo_frame_init(&frame, sizeof(frame)), FLOWDLO_OK);
        EXPECT_EQ(flowdlo_frame_folder_frame(loaded->get(), &frame), FLOWDLO_OK);
        const auto pixels = static_cast<std::size_t>(frame.width) * frame.height;
        return std::string(static_cast<const char*>(frame.depth.data), pixels * sizeof(float));
      });
}

TEST(CApiMemory, ARefusalSurvivesEveryAllocation) {
  for (const Fails fails : {Fails::kOnce, Fails::kFromOn}) {
    for (long number = 1; number < 12; ++number) {
      const flowdlo_status status = [&] {
        const FailingAllocation failing(fails, number);
        return flowdlo_frame_folder_load("a folder that is not there", nullptr);
      }();
      EXPECT_THAT(status, ::testing::AnyOf(FLOWDLO_BAD_INPUT, FLOWDLO_OUT_OF_MEMORY));
      EXPECT_STRNE(flowdlo_last_error(), "");
    }
  }
}

}  // namespace
}  // namespace flowdlo::testing
