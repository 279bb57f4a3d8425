// Exact pruning: the cloud is cut into blocks of consecutive points, each with its bounding box and
// its largest distance to the picks so far. A pick that is at least that far from the box changes
// nothing in the block. The bound is computed with the very operations of the distance; rounding is
// monotonic, so the bound holds for the rounded distances too, and no pick depends on the pruning.
#include "reference/farthest_points.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>
#include <vector>

namespace flowdlo::reference {
namespace {

constexpr std::size_t kPicks = 256;  // K_obs, Sec. 3.2
constexpr std::size_t kBlock = 64;   // points that share a bounding box
constexpr std::size_t kLanes = 8;    // independent running maxima, for the vectoriser
constexpr float kPadding = -1.0F;    // "distance" of rows past the end: below every real one
constexpr float kUnseen = std::numeric_limits<float>::infinity();

using Position = FarthestPointsMemory::Position;
using Block = FarthestPointsMemory::Block;

std::size_t blocks_of(std::size_t points) { return (points + kBlock - 1) / kBlock; }

float distance_squared(float dx, float dy, float dz) { return (dx * dx + dy * dy) + dz * dz; }

/// From `value` to the interval [low, high]: 0 inside, otherwise the rounded difference to the
/// nearer bound, whose magnitude no point of the interval undercuts.
float gap(float value, float low, float high) {
  if (value < low) return low - value;
  if (value > high) return value - high;
  return 0;
}

class Sampler {
 public:
  Sampler(std::span<const float> cloud_xyzw, std::size_t count, FarthestPointsMemory& memory);

  /// Index of the point farthest from `from`.
  [[nodiscard]] std::size_t farthest_from(const Position& from) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      approach(b, from);
      blocks_[b].farthest = largest(b);
    }
    const std::size_t index = farthest();
    std::fill(nearest_.begin(), nearest_.begin() + count_, kUnseen);
    for (Block& block : blocks_) block.farthest = kUnseen;
    return index;
  }

  /// Index of the point farthest from all picks, `last` being the newest.
  [[nodiscard]] std::size_t next(std::size_t last) {
    const Position pick = position(last);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      const float bound = distance_squared(gap(pick.x, block.low.x, block.high.x),
                                           gap(pick.y, block.low.y, block.high.y),
                                           gap(pick.z, block.low.z, block.high.z));
      if (bound >= block.farthest && block.farthest < kUnseen) continue;
      approach(b, pick);
      blocks_[b].farthest = largest(b);
    }
    return farthest();
  }

  [[nodiscard]] Position position(std::size_t index) const {
    return {x_[index], y_[index], z_[index]};
  }

 private:
  /// nearest_ = min(nearest_, distance to `pick`) over one block.
  void approach(std::size_t block, const Position& pick);
  [[nodiscard]] float largest(std::size_t block) const;
  /// Index of the largest entry of nearest_, the lowest one of equals.
  [[nodiscard]] std::size_t farthest() const;

  std::ptrdiff_t count_;
  std::vector<float>& x_;
  std::vector<float>& y_;
  std::vector<float>& z_;
  std::vector<float>& nearest_;
  std::vector<Block>& blocks_;
};

Sampler::Sampler(std::span<const float> cloud_xyzw, std::size_t count, FarthestPointsMemory& memory)
    : count_(static_cast<std::ptrdiff_t>(count)),
      x_(memory.x),
      y_(memory.y),
      z_(memory.z),
      nearest_(memory.nearest),
      blocks_(memory.blocks) {
  blocks_.resize(blocks_of(count));
  const std::size_t rows = blocks_.size() * kBlock;
  x_.assign(rows, 0);
  y_.assign(rows, 0);
  z_.assign(rows, 0);
  nearest_.assign(rows, kPadding);
  for (std::size_t i = 0; i < count; ++i) {
    x_[i] = cloud_xyzw[4 * i];
    y_[i] = cloud_xyzw[4 * i + 1];
    z_[i] = cloud_xyzw[4 * i + 2];
    nearest_[i] = kUnseen;
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    block = {position(b * kBlock), position(b * kBlock), kUnseen};
    for (std::size_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) {
      const Position point = position(i);
      block.low = {std::min(block.low.x, point.x), std::min(block.low.y, point.y),
                   std::min(block.low.z, point.z)};
      block.high = {std::max(block.high.x, point.x), std::max(block.high.y, point.y),
                    std::max(block.high.z, point.z)};
    }
  }
}

void Sampler::approach(std::size_t block, const Position& pick) {
  const float* const x = &x_[block * kBlock];
  const float* const y = &y_[block * kBlock];
  const float* const z = &z_[block * kBlock];
  float* const nearest = &nearest_[block * kBlock];
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float distance = distance_squared(x[i] - pick.x, y[i] - pick.y, z[i] - pick.z);
    nearest[i] = distance < nearest[i] ? distance : nearest[i];
  }
}

float Sampler::largest(std::size_t block) const {
  const float* const nearest = &nearest_[block * kBlock];
  std::array<float, kLanes> lanes{};
  std::copy_n(nearest, kLanes, lanes.begin());
  for (std::size_t i = kLanes; i < kBlock; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      lanes[lane] = nearest[i + lane] > lanes[lane] ? nearest[i + lane] : lanes[lane];
    }
  }
  return *std::max_element(lanes.begin(), lanes.end());
}

std::size_t Sampler::farthest() const {
  const auto block =
      std::max_element(blocks_.begin(), blocks_.end(), [](const Block& a, const Block& b) {
        return a.farthest < b.farthest;  // max_element keeps the first of equals
      });
  const auto first = nearest_.begin() + (block - blocks_.begin()) * std::ptrdiff_t{kBlock};
  return static_cast<std::size_t>(std::max_element(first, first + kBlock) - nearest_.begin());
}

void write_row(std::span<float> visible, std::size_t row, const Position& point, float valid) {
  visible[4 * row] = point.x;
  visible[4 * row + 1] = point.y;
  visible[4 * row + 2] = point.z;
  visible[4 * row + 3] = valid;
}

}  // namespace

void FarthestPointsMemory::reserve(std::size_t points) {
  const std::size_t rows = blocks_of(points) * kBlock;
  for (std::vector<float>* values : {&x, &y, &z, &nearest}) values->reserve(rows);
  blocks.reserve(blocks_of(points));
}

void farthest_points(std::span<const float> cloud_xyzw, int count, const float centroid[3],
                     std::span<float> visible) {
  FarthestPointsMemory memory;
  farthest_points(cloud_xyzw, count, centroid, visible, memory);
}

void farthest_points(std::span<const float> cloud_xyzw, int count, const float centroid[3],
                     std::span<float> visible, FarthestPointsMemory& memory) {
  assert(visible.size() >= 4 * kPicks);
  assert(count >= 0 && cloud_xyzw.size() >= 4 * static_cast<std::size_t>(count));
  const auto points = static_cast<std::size_t>(count);
  if (points == 0) {
    std::fill_n(visible.begin(), 4 * kPicks, 0.0F);
    return;
  }
  if (points <= kPicks) {
    for (std::size_t row = 0; row < kPicks; ++row) {
      const float* const point = &cloud_xyzw[4 * (row % points)];
      write_row(visible, row, {point[0], point[1], point[2]}, row < points ? 1.0F : 0.0F);
    }
    return;
  }
  Sampler sampler(cloud_xyzw, points, memory);
  std::size_t pick = sampler.farthest_from({centroid[0], centroid[1], centroid[2]});
  write_row(visible, 0, sampler.position(pick), 1);
  for (std::size_t row = 1; row < kPicks; ++row) {
    pick = sampler.next(pick);
    write_row(visible, row, sampler.position(pick), 1);
  }
}

}  // namespace flowdlo::reference
