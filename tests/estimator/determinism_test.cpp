// One frame, one configuration: the same bits, however often, on however many threads, in whatever
// company and after whatever went wrong. FLOWDLO_REPEATS says how often a frame is estimated.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "flowdlo/frame_folder.hpp"
#include "support/estimate_bits.hpp"
#include "support/rose_frame.hpp"
#include "support/source_dir.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::bits_of;
using testing::EstimateBits;
using testing::RoseFrame;
using testing::WaveFrame;

constexpr int kRepeats = 16;  // where nothing else is said
constexpr int kMostThreads = 8;
constexpr int kSideBySide = 4;  // estimators

int repeats() {
  const char* const asked = std::getenv("FLOWDLO_REPEATS");
  return asked == nullptr ? kRepeats : std::max(1, std::atoi(asked));
}

/// The model that ships, with the gate that reads a doubtful mask again.
Config config_on(const std::string& device, int threads = 0) {
  return {.weights = FLOWDLO_DEFAULT_WEIGHTS,
          .device = device,
          .euler_steps = 2,
          .draws = 2,
          .threads = threads};
}

Estimator make(const Config& config) {
  auto estimator = Estimator::create(config);
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

/// A clear rope with a crossing, and one that leaves doubt.
class Frames {
 public:
  static constexpr int kCount = 2;

  [[nodiscard]] Frame operator[](int i) const { return i % kCount == 0 ? loop() : rose_.frame(); }
  [[nodiscard]] Frame loop() const { return loop_->frame(); }

 private:
  Result<FrameFolder> loop_ =
      load_frame_folder(test::source_dir() / "examples/frames/overhand_loop");
  RoseFrame rose_;
};

class SameBits : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto made = Estimator::create(config_on(GetParam()));
    if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
    ASSERT_TRUE(made) << made.error().message;
  }
  /// Of a new estimator that has seen nothing else.
  [[nodiscard]] EstimateBits fresh(const Frame& frame) const {
    auto estimator = make(config_on(GetParam()));
    return bits_of(estimator, frame);
  }

  Frames frames_;
};

TEST_P(SameBits, HoweverOftenAndInTurns) {
  const std::vector<EstimateBits> first{fresh(frames_[0]), fresh(frames_[1])};
  auto estimator = make(config_on(GetParam()));
  for (int i = 0; i < repeats(); ++i) {
    ASSERT_EQ(bits_of(estimator, frames_[i]), first[static_cast<std::size_t>(i) % Frames::kCount])
        << "frame " << i;
  }
}

TEST_P(SameBits, OnOneToEightThreads) {
  for (int i = 0; i < Frames::kCount; ++i) {
    const EstimateBits first = fresh(frames_[i]);
    for (int threads = 1; threads <= kMostThreads; ++threads) {
      auto estimator = make(config_on(GetParam(), threads));
      for (int again = 0; again < std::max(1, repeats() / (2 * kMostThreads)); ++again) {
        ASSERT_EQ(bits_of(estimator, frames_[i]), first) << threads << " threads, frame " << i;
      }
    }
  }
}

TEST_P(SameBits, OfEstimatorsSideBySide) {
  const std::vector<EstimateBits> first{fresh(frames_[0]), fresh(frames_[1])};
  std::vector<std::future<int>> differing;
  for (int e = 0; e < kSideBySide; ++e) {
    differing.push_back(std::async(std::launch::async, [&, e] {
      auto estimator = make(config_on(GetParam()));
      int count = 0;
      for (int i = e; i < e + repeats() / kSideBySide; ++i) {  // not in step with one another
        const auto& expected = first[static_cast<std::size_t>(i) % Frames::kCount];
        count += bits_of(estimator, frames_[i]) == expected ? 0 : 1;
      }
      return count;
    }));
  }
  for (auto& count : differing) EXPECT_EQ(count.get(), 0);
}

TEST_P(SameBits, AfterFramesThatFail) {
  WaveFrame no_mask;
  std::fill(no_mask.mask.begin(), no_mask.mask.end(), std::uint8_t{0});
  WaveFrame no_depth;
  std::fill(no_depth.depth_m.begin(), no_depth.depth_m.end(), 0.0F);
  WaveFrame speck = no_mask;
  speck.mask[100 * 320 + 100] = 255;
  Frame malformed = frames_.loop();
  malformed.depth_m = malformed.depth_m.first(100);
  malformed.intrinsics.fx = -1;

  const EstimateBits first = fresh(frames_.loop());
  auto estimator = make(config_on(GetParam()));
  for (int i = 0; i < std::max(1, repeats() / 4); ++i) {
    for (const Frame& bad : {no_mask.frame(), no_depth.frame(), speck.frame(), malformed}) {
      ASSERT_FALSE(estimator.estimate(bad));
      ASSERT_EQ(bits_of(estimator, frames_.loop()), first);
    }
  }
}

TEST_P(SameBits, AfterAFrameThatNeedsMoreMemory) {
  const WaveFrame large(1600, 1200, 40.0F);
  const EstimateBits first = fresh(frames_.loop());
  auto estimator = make(config_on(GetParam()));
  ASSERT_TRUE(estimator.estimate(large.frame()));
  EXPECT_EQ(bits_of(estimator, frames_.loop()), first);
}

INSTANTIATE_TEST_SUITE_P(On, SameBits, ::testing::Values("cpu", "vulkan"),
                         [](const auto& device) { return std::string(device.param); });

/// The most threads that the process has while `work` runs.
template <class Work>
int most_threads(const Work& work) {
  const auto count = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return static_cast<int>(std::distance(begin(tasks), end(tasks)));
  };
  std::atomic<bool> done = false;
  std::atomic<int> most = 0;
  std::thread watch([&] {
    do {
      most = std::max(most.load(), count() - 1);  // without this one
    } while (!done);
  });
  work();
  done = true;
  watch.join();
  return most;
}

TEST(Threads, AreNotStartedByAnEstimatorThatMayHaveOne) {
  Config config = config_on("cpu");
  config.threads = 1;
  const Frames frames;
  ASSERT_EQ(most_threads([] {}), 1) << "before";
  const int most = most_threads([&] {
    Estimator estimator = make(config);
    for (int i = 0; i < Frames::kCount; ++i) {
      const auto estimate = estimator.estimate(frames[i]);
      ASSERT_TRUE(estimate) << estimate.error().message;
      ASSERT_TRUE(estimator.estimate_ropes(frames[i]));
    }
  });
  EXPECT_EQ(most, 1);
}

/// How many threads of this process Mesa's CPU driver started: it names them after itself.
int driver_threads() {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "comm");
    std::string name;
    std::getline(file, name);
    count += name.starts_with("llvmpipe") ? 1 : 0;
  }
  return count;
}

/// An estimator for which Mesa's CPU driver has that many threads: it asks LP_NUM_THREADS when a
/// device is opened.
Estimator make_on_lavapipe(const Config& config, int threads) {
  const char* const outside = std::getenv("LP_NUM_THREADS");
  const std::string before = outside == nullptr ? "" : outside;
  ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  Estimator estimator = make(config);
  if (outside == nullptr) {
    ::unsetenv("LP_NUM_THREADS");
  } else {
    ::setenv("LP_NUM_THREADS", before.c_str(), 1);
  }
  return estimator;
}

TEST(SameBitsOfLavapipe, OnOneToEightThreadsOfItsOwn) {
  const Config config = config_on("vulkan");
  auto made = Estimator::create(config);
  if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
  ASSERT_TRUE(made) << made.error().message;
  if (made->device().find("llvmpipe") == std::string::npos) GTEST_SKIP() << made->device();
  const Frames frames;
  const std::vector<EstimateBits> first{bits_of(*made, frames[0]), bits_of(*made, frames[1])};
  const int others = driver_threads();
  for (int threads = 1; threads <= kMostThreads; ++threads) {
    auto estimator = make_on_lavapipe(config, threads);
    ASSERT_EQ(driver_threads() - others, threads);
    for (int i = 0; i < std::max(Frames::kCount, repeats() / kMostThreads); ++i) {
      ASSERT_EQ(bits_of(estimator, frames[i]), first[static_cast<std::size_t>(i) % Frames::kCount])
          << threads << " threads, frame " << i;
    }
  }
}

TEST(SameBitsAfterALostDevice, OnTheNextEstimator) {
  const Frames frames;
  Config config = config_on("vulkan");
  const auto made = Estimator::create(config);
  if (!made && made.error().code == ErrorCode::kNoDevice) GTEST_SKIP() << made.error().message;
  auto before = make(config);
  const EstimateBits first = bits_of(before, frames.loop());

  config.device_timeout_ms = 1;
  config.draws = 8;  // more than a device does within that
  config.euler_steps = 16;
  auto hasty = Estimator::create(config);
  if (!hasty) {  // a GPU is tried at once, a CPU driver is not
    EXPECT_EQ(before.device().find("llvmpipe"), std::string::npos) << hasty.error().message;
    EXPECT_EQ(hasty.error().code, ErrorCode::kDeviceLost);
  }
  for (int i = 0; hasty && i < 2; ++i) {
    const auto estimate = hasty->estimate(frames.loop());
    ASSERT_FALSE(estimate);
    EXPECT_EQ(estimate.error().code, ErrorCode::kDeviceLost);
  }

  EXPECT_EQ(bits_of(before, frames.loop()), first);
  auto after = make(config_on("vulkan"));
  EXPECT_EQ(bits_of(after, frames.loop()), first);
}

}  // namespace
}  // namespace flowdlo
