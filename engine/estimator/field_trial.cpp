#include "estimator/field_trial.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace flowdlo::estimator {
namespace {

constexpr int kSide_px = 8 * field::kBlock_px;
constexpr int kTimes = 2;  // the faster of which counts, after one that nobody times

/// Ripples of another wavelength in each plane: no two blocks are alike.
field::Planes rippled() {
  field::Planes planes({kSide_px, kSide_px});
  for (int v = 0; v < kSide_px; ++v) {
    for (int u = 0; u < kSide_px; ++u) {
      for (std::size_t plane = 0; plane < field::kPlanes; ++plane) {
        const auto wave = 0.05F + 0.03F * static_cast<float>(plane);
        planes.row(v)[u][plane] =
            std::sin(wave * static_cast<float>(u)) * std::cos(0.7F * wave * static_cast<float>(v));
      }
    }
  }
  return planes;
}

struct Run {
  field::Channels seen;
  double ms = 0;
};

Result<Run> run(field::Network& network, const field::Planes& planes,
                const field::BlockMap& blocks) {
  using Clock = std::chrono::steady_clock;
  auto seen = network.see(planes, blocks);  // the first time is no measure
  double least_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes && seen; ++i) {
    const auto begin = Clock::now();
    seen = network.see(planes, blocks);
    const std::chrono::duration<double, std::milli> took = Clock::now() - begin;
    least_ms = std::min(least_ms, took.count());
  }
  if (!seen) return seen.error();
  return Run{*std::move(seen), least_ms};
}

float difference_of(const field::Channels& got, const field::Channels& wanted, std::size_t blocks) {
  float most = 0;
  float reach = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    for (int pixel = 0; pixel < field::kBlock_px * field::kBlock_px; ++pixel) {
      for (std::size_t c = 0; c < field::kChannels; ++c) {
        const float want = wanted.block(block)[pixel][c];
        const float off = std::abs(got.block(block)[pixel][c] - want);
        most = std::isfinite(off) ? std::max(most, off) : std::numeric_limits<float>::infinity();
        reach = std::max(reach, std::abs(want));
      }
    }
  }
  return reach > 0 ? most / reach : most;
}

}  // namespace

Result<FieldTrial> try_field(field::Network& device, field::Network& cpu) {
  const field::Planes planes = rippled();
  const field::BlockMap blocks = field::all_blocks(planes.size());
  const auto got = run(device, planes, blocks);
  if (!got) return got.error();
  const auto wanted = run(cpu, planes, blocks);
  if (!wanted) return wanted.error();
  return FieldTrial{difference_of(got->seen, wanted->seen, blocks.blocks.size()), got->ms,
                    wanted->ms};
}

}  // namespace flowdlo::estimator
