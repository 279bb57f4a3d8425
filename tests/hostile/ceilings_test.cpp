// Whatever the mask holds: processor time beside an ordinary frame of the same size in the same
// run, and the peak of memory. The whole corpus is flowdlo-lab hostile-report's.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "hostile/cost.hpp"
#include "hostile/hostile_frame.hpp"
#include "hostile/hostile_mask.hpp"
#include "overlay.hpp"
#include "support/peak_memory.hpp"

namespace flowdlo::lab {
namespace {

/// Of an ordinary frame's processor time. An ordinary, clear frame takes about 0.2 s at 640 x 480.
constexpr double kMostTimes = 4;
constexpr int kTurns = 3;

/// Of the whole process, the caller's frames and the weights among it.
constexpr double kMostPeakMb = 600;

Estimator make() {
  auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                                      .device = "cpu",
                                      .quality = Quality::kFull,
                                      .threads = 1});
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

HostileMask mask_of(const std::string& name) {
  for (const HostileMask& mask : hostile_corpus()) {
    if (mask.name() == name) return mask;
  }
  throw std::runtime_error("no such mask: " + name);
}

/// Ordinary and hostile by turns, the least of each: a machine that slows down slows both. One
/// frame is there at a time.
double times_ordinary(const std::string& name, Estimator& estimator, double& peak_mb) {
  const HostileMask mask = mask_of(name);
  const auto cost_around = [&](const cv::Mat& drawn) {
    const FrameFolder frame = frame_around(drawn, name);
    return cost_of(frame.frame(), estimator, 1);
  };
  double ordinary_s = std::numeric_limits<double>::max();
  double hostile_s = std::numeric_limits<double>::max();
  for (int turn = 0; turn < kTurns; ++turn) {
    ordinary_s = std::min(ordinary_s, cost_around(draw_ordinary(mask.size_px)).cpu_s);
    const Cost cost = cost_around(draw(mask));
    hostile_s = std::min(hostile_s, cost.cpu_s);
    peak_mb = std::max(peak_mb, cost.peak_mb);
  }
  return hostile_s / ordinary_s;
}

class Ceilings : public testing::TestWithParam<const char*> {};

TEST_P(Ceilings, HoldInTimeAndMemory) {
  auto estimator = make();
  double peak_mb = 0;
  EXPECT_LE(times_ordinary(GetParam(), estimator, peak_mb), kMostTimes);
  if (!test::kSanitized) {
    EXPECT_LE(peak_mb, kMostPeakMb);
  }
}

INSTANTIATE_TEST_SUITE_P(Small, Ceilings,
                         testing::Values("noise_50_640x480", "blobs_27_640x480", "text_40_640x480",
                                         "hairs_400_640x480", "comb_2_640x480", "grid_20_640x480",
                                         "checker_33_640x480", "full_0_640x480"));
INSTANTIATE_TEST_SUITE_P(Large, Ceilings,
                         testing::Values("noise_60_1920x1080", "noise_50_4096x4096",
                                         "disc_60_4096x4096", "ragged_3_4096x4096"));

double cpu_now_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double overlay_s(const FrameFolder& frame) {
  double least_s = 1e9;
  for (int round = 0; round < 3; ++round) {
    const double before = cpu_now_s();
    (void)tools::draw_overlay(frame.frame(), Estimate{}, "cpu");
    least_s = std::min(least_s, cpu_now_s() - before);
  }
  return least_s;
}

TEST(OverlayCeiling, OfNoiseIsThatOfARope) {
  const cv::Size size_px(1920, 1080);
  const auto ordinary = frame_around(draw_ordinary(size_px), "ordinary");
  const auto noise = frame_around(draw(mask_of("noise_50_1920x1080")), "noise");
  EXPECT_LE(overlay_s(noise), kMostTimes * overlay_s(ordinary));
}

}  // namespace
}  // namespace flowdlo::lab
