// Images in blocks for tests: which blocks are in use and where they lie, and the same operations
// over the whole picture in double precision, which know nothing of blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "random/philox.hpp"

namespace flowdlo::testing {

/// Blocks in use, in no order, on a square of `across` x `across` blocks.
struct BlockMap {
  int capacity = 0;
  int across = 0;
  std::vector<int> cells;   ///< of each block in use, row by row on the square
  std::vector<float> rows;  ///< [capacity, 12], see ops/program.hpp

  [[nodiscard]] int used() const { return static_cast<int>(cells.size()); }
};

inline BlockMap block_map(int capacity, int used, int across, std::uint64_t seed) {
  BlockMap map{.capacity = capacity, .across = across, .cells = {}, .rows = {}};
  std::vector<std::pair<float, int>> order;
  for (int cell = 0; cell < across * across; ++cell) {
    order.emplace_back(random::gaussian(seed, static_cast<std::uint64_t>(cell))[0], cell);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> block_of(order.size(), -1);
  for (int block = 0; block < used; ++block) {
    map.cells.push_back(order[static_cast<std::size_t>(block)].second);
    block_of[static_cast<std::size_t>(map.cells.back())] = block;
  }
  for (int block = 0; block < used; ++block) {
    const int cell = map.cells[static_cast<std::size_t>(block)];
    for (int entry = 0; entry < 9; ++entry) {
      const int row = cell / across + entry / 3 - 1;
      const int column = cell % across + entry % 3 - 1;
      const bool inside = std::min(row, column) >= 0 && std::max(row, column) < across;
      const int other = inside ? block_of[static_cast<std::size_t>(row * across + column)] : -1;
      map.rows.push_back(static_cast<float>(other));
    }
    map.rows.insert(map.rows.end(), 3, 0.0F);
  }
  for (int block = used; block < capacity; ++block) {  // only column 4 means anything
    for (int entry = 0; entry < 12; ++entry) map.rows.push_back(entry == 4 ? -1.0F : 1e6F);
  }
  return map;
}

/// The picture that the blocks are parts of: [across * side, across * side, channels], zeros where
/// there is no block.
class Picture {
 public:
  Picture(const BlockMap& map, int side, int channels)
      : map_(&map),
        side_(side),
        channels_(channels),
        values_(static_cast<std::size_t>(edge()) * edge() * channels) {}
  Picture(const BlockMap& map, int side, int channels, std::span<const float> blocks)
      : Picture(map, side, channels) {
    for_each_in_use([&](std::size_t row, int v, int u, int channel) {
      at(v, u, channel) = static_cast<double>(blocks[row * channels_ + channel]);
    });
  }

  [[nodiscard]] int edge() const { return map_->across * side_; }
  [[nodiscard]] double& at(int v, int u, int channel) {
    return values_[(static_cast<std::size_t>(v) * edge() + u) * channels_ + channel];
  }
  /// Zero beyond the edge.
  [[nodiscard]] double seen(int v, int u, int channel) const {
    if (std::min(v, u) < 0 || std::max(v, u) >= edge()) return 0;
    return values_[(static_cast<std::size_t>(v) * edge() + u) * channels_ + channel];
  }
  /// visit(row of the tensor, v, u, channel) of all places of blocks in use.
  template <class Visit>
  void for_each_in_use(const Visit& visit) const {
    for (int block = 0; block < map_->used(); ++block) {
      const int cell = map_->cells[static_cast<std::size_t>(block)];
      for (int place = 0; place < side_ * side_; ++place) {
        const int v = cell / map_->across * side_ + place / side_;
        const int u = cell % map_->across * side_ + place % side_;
        const std::size_t row = static_cast<std::size_t>(block) * side_ * side_ + place;
        for (int channel = 0; channel < channels_; ++channel) visit(row, v, u, channel);
      }
    }
  }

 private:
  const BlockMap* map_;
  int side_;
  int channels_;
  std::vector<double> values_;
};

/// weight [out, taps, in], bias [out]; the rows of blocks in use, [used * side^2, out].
inline std::vector<double> plain_convolution(const BlockMap& map, int side, int in, int out,
                                             int taps, bool relu, std::span<const float> x,
                                             std::span<const float> weight,
                                             std::span<const float> bias) {
  const Picture picture(map, side, in, x);
  const Picture shape(map, side, out);
  const int reach = taps == 9 ? 1 : 0;
  std::vector<double> y(static_cast<std::size_t>(map.used()) * side * side * out);
  shape.for_each_in_use([&](std::size_t row, int v, int u, int column) {
    double sum = static_cast<double>(bias[column]);
    std::size_t next = static_cast<std::size_t>(column) * taps * in;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        for (int channel = 0; channel < in; ++channel) {
          sum += static_cast<double>(weight[next++]) * picture.seen(v + dy, u + dx, channel);
        }
      }
    }
    y[row * out + column] = relu ? std::max(sum, 0.0) : sum;
  });
  return y;
}

}  // namespace flowdlo::testing
