// flowdlo_soak SECONDS WEIGHTS [SEED]: estimators are made, used and let go until the time is over,
// on every device. Ends with 1 where bits change, or memory, open files or threads grow.
#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "flowdlo/devices.hpp"
#include "growth.hpp"
#include "life.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using flowdlo::soak::Allowance;
using flowdlo::soak::Growth;
using flowdlo::soak::Place;

constexpr double kReportEvery_s = 30;

/// The native back end, and the CPU driver of Vulkan where there is one. A GPU is no part of it:
/// its driver keeps what it likes.
std::vector<Place> places() {
  std::vector<Place> found{{"cpu", "cpu"}};
  for (const auto& device : flowdlo::survey_devices(false).vulkan) {
    if (device.kind != flowdlo::DeviceKind::kCpu || !device.lacks.empty()) continue;
    found.push_back({device.uuid, device.name});
    return found;
  }
  fmt::print("skipped: no CPU driver of Vulkan; install mesa-vulkan-drivers\n");
  return found;
}

/// One device's share of the run.
struct Trial {
  Place place;
  Growth growth;
  flowdlo::soak::Tally tally;
};

void report(const Trial& trial, double minutes) {
  const auto early = trial.growth.early();
  const auto late = trial.growth.late();
  fmt::print(
      "{:6.1f} min  {:<40}  {:5} lives  {:6} frames ({} refused)  resident {:6.1f} -> {:6.1f} MB  "
      "heap {:6.2f} -> {:6.2f} MB  "
      "files {:.0f} -> {:.0f}  threads {:.0f} -> {:.0f}\n",
      minutes, trial.place.name, trial.growth.lives(), trial.tally.frames, trial.tally.refused,
      early.resident_mb, late.resident_mb, early.heap_mb, late.heap_mb, early.descriptors,
      late.descriptors, early.threads, late.threads);
  std::fflush(stdout);
}

/// Runs one device alone, so that what grows has a name.
bool soak(Trial& trial, const std::string& weights, double seconds, std::mt19937_64& dice,
          flowdlo::soak::Memory& memory) {
  if (const auto warm = flowdlo::soak::warm_up(trial.place, weights); !warm) {
    fmt::print("failed at once: {}\n", warm.error().message);
    return false;
  }
  const auto begin = Clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  double reported_s = 0;
  while (elapsed_s() < seconds) {
    const auto lived = flowdlo::soak::live(trial.place, weights, dice, memory, trial.tally);
    if (!lived) {
      fmt::print("failed after {} lives: {}\n", trial.growth.lives(), lived.error().message);
      return false;
    }
    trial.growth.add(flowdlo::soak::footprint());
    if (elapsed_s() - reported_s < kReportEvery_s) continue;
    reported_s = elapsed_s();
    report(trial, reported_s / 60);
  }
  report(trial, elapsed_s() / 60);
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    fmt::print(stderr, "usage: {} SECONDS WEIGHTS [SEED]\n", arguments[0]);
    return 2;
  }
  const double seconds = std::atof(arguments[1]);
  std::mt19937_64 dice(count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 1);
#ifdef __GLIBC__
  // Of several heaps glibc keeps more and more of what was freed: 70 to 118 MB in 350 lives. That
  // is no leak, and it hides one.
  ::mallopt(M_ARENA_MAX, 1);
#endif
  // What sizes of frames and what malloc sets aside for a thread bring about, measured over 360
  // lives: 0.3 MB resident. OpenCV keeps 1.2 kB for good for every thread that ever called it, and
  // a life has up to three of its own.
  const Allowance allowance{
      .resident_mb = 4, .heap_mb = 0.25, .heap_mb_a_life = 0.004, .descriptors = 0, .threads = 0};
  flowdlo::soak::Memory memory;
  bool flat = true;
  const auto all = places();
  for (const Place& place : all) {
    Trial trial{place, {}, {}};
    if (!soak(trial, arguments[2], seconds / static_cast<double>(all.size()), dice, memory)) {
      return 1;
    }
    for (const auto& fault : trial.growth.faults(allowance)) {
      fmt::print("{}: {}\n", place.name, fault);
      flat = false;
    }
  }
  fmt::print("{} frames seen before came with the same bits\n", memory.comparisons());
  return flat ? 0 : 1;
}
