#include "prior/sunken.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

using geometry::quantile;

constexpr float kBlockWidths = 0.5F;
constexpr float kLeastBlockPx = 4.0F;
constexpr std::size_t kLeastReadings = 2;  // of a block
constexpr float kCoreWidths = 0.35F;       // from the axis
constexpr float kNearShare = 0.35F;        // quantile of a block's depths: pixels fly backwards
constexpr float kSteepest = 2.7F;          // metres of depth a metre aside
constexpr float kSteeper = 1.5F;           // times as steep as on both sides
constexpr std::size_t kSlopeBlocks = 3;    // which are so long
constexpr float kJumpWidths = 2.0F;
constexpr float kJumpShare = 0.01F;      // of the depth: noise
constexpr float kHoleWidths = 6.0F;      // without readings
constexpr float kSunkShare = 0.35F;      // of the neighbour's height over the background, at most
constexpr std::size_t kLeastBlocks = 6;  // of a stretch in mid-air
constexpr float kHighWidths = 10.0F;     // over the background: in mid-air
constexpr float kHighShare = 0.35F;      // and of the highest stretch's height
constexpr float kLeastHanging = 0.25F;   // of all blocks; less is something before the rope

struct Block {
  float arclength_px = 0;
  float depth_m = 0;
  float beside_m = 0;  // 0: unknown
  float aside = 0;
};

/// Blocks that neither a jump nor a hole parts.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  bool hangs = false;  // high over the background
  bool sunk = false;
};

std::vector<Block> blocks_of(const Strip& strip, int length) {
  const std::size_t count = (strip.stations.size() - 1) / static_cast<std::size_t>(length) + 1;
  std::vector<std::vector<float>> depths(count);
  std::vector<std::vector<float>> beside(count);
  for (const Reading& reading : strip.readings) {
    if (reading.rival >= 0 || std::abs(reading.offset_px) > kCoreWidths * strip.width_px + 0.5F)
      continue;
    depths[static_cast<std::size_t>(reading.station / length)].push_back(reading.depth_m);
  }
  for (std::size_t i = 0; i < strip.stations.size(); ++i) {
    const float depth_m = strip.stations[i].beside_m;
    if (depth_m > 0) beside[i / static_cast<std::size_t>(length)].push_back(depth_m);
  }
  std::vector<Block> blocks;
  for (std::size_t b = 0; b < count; ++b) {
    if (depths[b].size() < kLeastReadings) continue;
    const Station& at = strip.stations[b * static_cast<std::size_t>(length)];
    blocks.push_back({at.arclength_px, quantile(depths[b], kNearShare),
                      beside[b].empty() ? 0 : quantile(beside[b], 0.5F), at.aside});
  }
  return blocks;
}

/// The blocks with the slopes that runs of them have at their ends.
class Profile {
 public:
  Profile(const std::vector<Block>& blocks, float width_px)
      : blocks_(blocks), width_px_(width_px) {}

  /// True when the rope may go on from block `a`, the last one of those before it, to block `b`,
  /// which comes after it: not steeper than a rope bends away, or as steep as it runs before `a`
  /// and after `b`. `first` and `last` bound the blocks that tell.
  [[nodiscard]] bool joins(std::size_t a, std::size_t b, std::size_t first,
                           std::size_t last) const {
    const Block& before = blocks_[a];
    const Block& after = blocks_[b];
    const float rise_m = after.depth_m - before.depth_m;
    const float apart_px = after.arclength_px - before.arclength_px;
    const float near_m = std::min(before.depth_m, after.depth_m);
    const float reach_m = near_m * (kSteepest * apart_px * before.aside +
                                    kJumpWidths * width_px_ * before.aside + kJumpShare);
    if (std::abs(rise_m) <= reach_m) return true;
    const float way = rise_m > 0 ? 1.0F : -1.0F;
    const float slope =
        std::min(way * slope_at(a > first + kSlopeBlocks ? a - kSlopeBlocks : first, a),
                 way * slope_at(b, std::min(b + kSlopeBlocks, last)));
    const float steep_m = kSteeper * slope * apart_px * before.depth_m * after.depth_m;
    return std::abs(rise_m) <= reach_m + std::max(0.0F, steep_m);
  }

 private:
  /// How fast the inverse depth, linear along a straight rope, falls from one block to the other.
  [[nodiscard]] float slope_at(std::size_t a, std::size_t b) const {
    if (a >= b) return 0;
    return (1 / blocks_[a].depth_m - 1 / blocks_[b].depth_m) /
           (blocks_[b].arclength_px - blocks_[a].arclength_px);
  }

  const std::vector<Block>& blocks_;
  float width_px_;
};

std::vector<Run> runs_of(const std::vector<Block>& blocks, float width_px) {
  const Profile profile(blocks, width_px);
  std::vector<Run> runs{{0, 0}};
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const bool jump = !profile.joins(i - 1, i, 0, blocks.size() - 1);
    const bool hole = blocks[i].arclength_px - blocks[i - 1].arclength_px > kHoleWidths * width_px;
    if (jump || hole) runs.push_back({i, i});
    runs.back().last = i;
  }
  return runs;
}

/// Median height of a run's blocks over the background; nothing without any.
std::optional<float> height_m(const std::vector<Block>& blocks, const Run& run) {
  std::vector<float> heights;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    if (blocks[i].beside_m > 0) heights.push_back(blocks[i].beside_m - blocks[i].depth_m);
  }
  if (heights.empty()) return std::nullopt;
  return quantile(heights, 0.5F);
}

/// The same as a share of the height that `near_m` has there.
std::optional<float> height_share(const std::vector<Block>& blocks, const Run& run, float near_m) {
  std::vector<float> shares;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    const Block& block = blocks[i];
    if (block.beside_m <= near_m) continue;
    shares.push_back((block.beside_m - block.depth_m) / (block.beside_m - near_m));
  }
  if (shares.empty()) return std::nullopt;
  return quantile(shares, 0.5F);
}

std::size_t size(const Run& run) { return run.last - run.first + 1; }

/// Marks the runs high over the background, beside the highest; their share of all blocks.
float mark_hanging(const std::vector<Block>& blocks, float width_px, std::vector<Run>& runs) {
  float highest_m = 0;
  for (const Run& run : runs) {
    if (size(run) >= kLeastBlocks) {
      highest_m = std::max(highest_m, height_m(blocks, run).value_or(0));
    }
  }
  std::size_t hanging = 0;
  for (Run& run : runs) {
    const Block& middle = blocks[(run.first + run.last) / 2];
    const float width_m = width_px * middle.aside * middle.depth_m;
    run.hangs =
        size(run) >= kLeastBlocks &&
        height_m(blocks, run).value_or(0) > std::max(kHighWidths * width_m, kHighShare * highest_m);
    if (run.hangs) hanging += size(run);
  }
  return static_cast<float>(hanging) / static_cast<float>(blocks.size());
}

/// The nearest run in mid-air before `r` (`step` -1) or after it (1); null without one.
const Run* hanging_beside(const std::vector<Run>& runs, std::size_t r, int step) {
  for (auto i = static_cast<std::ptrdiff_t>(r) + step;
       i >= 0 && i < static_cast<std::ptrdiff_t>(runs.size()); i += step) {
    const Run& run = runs[static_cast<std::size_t>(i)];
    if (run.hangs) return &run;
  }
  return nullptr;
}

/// Marks the runs that are sunk: farther than those in mid-air around them, and close to the
/// background; or a few pixels somewhere between the two.
void mark_sunk(const std::vector<Block>& blocks, float width_px, std::vector<Run>& runs) {
  if (mark_hanging(blocks, width_px, runs) < kLeastHanging) return;
  const Profile profile(blocks, width_px);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    float near_m = 0;  // of the neighbours in mid-air
    int behind = 0;
    bool nearer = false;
    const auto compare = [&](const Block& there, const Block& here) {
      nearer = nearer || here.depth_m < there.depth_m;
      ++behind;
      near_m = std::max(near_m, there.depth_m);
    };
    const Run& run = runs[r];
    const Run* before = hanging_beside(runs, r, -1);
    if (before != nullptr && !profile.joins(before->last, run.first, before->first, run.last)) {
      compare(blocks[before->last], blocks[run.first]);
    }
    const Run* after = hanging_beside(runs, r, 1);
    if (after != nullptr && !profile.joins(run.last, after->first, run.first, after->last)) {
      compare(blocks[after->first], blocks[run.last]);
    }
    if (behind == 0 || nearer) continue;
    const auto share = height_share(blocks, runs[r], near_m);
    const bool between = behind == 2 && size(runs[r]) < kLeastBlocks;
    runs[r].sunk = between || (share && *share <= kSunkShare);
  }
}

}  // namespace

void drop_sunken(Strip& strip) {
  const float step_px = std::max(strip.step_px, 1e-3F);
  const int length = std::max(
      1, static_cast<int>(std::max(kBlockWidths * strip.width_px, kLeastBlockPx) / step_px));
  const std::vector<Block> blocks = blocks_of(strip, length);
  if (blocks.empty()) return;
  std::vector<Run> runs = runs_of(blocks, strip.width_px);
  if (runs.size() < 2) return;
  mark_sunk(blocks, strip.width_px, runs);
  std::vector<std::uint8_t> drop(strip.stations.size(), 0);
  for (const Run& run : runs) {
    if (!run.sunk) continue;
    for (std::size_t i = 0; i < strip.stations.size(); ++i) {
      const float at = strip.stations[i].arclength_px;
      const float last = blocks[run.last].arclength_px + static_cast<float>(length) * step_px;
      if (at >= blocks[run.first].arclength_px && at < last) drop[i] = 1;
    }
  }
  std::erase_if(strip.readings, [&](const Reading& reading) {
    return drop[static_cast<std::size_t>(reading.station)] != 0;
  });
}

}  // namespace flowdlo::prior
