// BlockMap: which blocks of a region are near the mask, and which lie beside each other. Only these
// are computed: a thin rope, magnified, would otherwise cost a hundred times its area.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "image/image.hpp"

namespace flowdlo::field {

inline constexpr int kFold = 2;        ///< pixels of the region a place, in u and in v
inline constexpr int kBlockSide = 16;  ///< places a side of a block, see ops::Convolution
inline constexpr int kBlock_px = kFold * kBlockSide;

/// Blocks that hold a pixel within this of the mask are computed: a rope's width. 12 px take a
/// sixth more blocks on long ropes, and the field's lines and ends are no better (docs/field.md).
inline constexpr int kNear_px = 8;

/// Which blocks: row by row.
struct BlockMap {
  int columns = 0;
  int rows = 0;
  std::vector<image::Point> blocks;  ///< column and row of each
  std::vector<int> index;            ///< [rows, columns] into `blocks`, -1: not computed

  /// The number of the block at a column and row of the map; -1: none.
  [[nodiscard]] int number_of(const image::Point& at) const {
    return index[static_cast<std::size_t>(at.y * columns + at.x)];
  }

  /// [9] the blocks around block `i`, itself in the middle, row by row; -1: none.
  [[nodiscard]] std::array<int, 9> around(std::size_t i) const;
};

/// Where a block lies in the region; blocks at its right and lower end may reach beyond it.
[[nodiscard]] inline image::Rect pixels_of(const image::Point& block) {
  return {block.x * kBlock_px, block.y * kBlock_px, kBlock_px, kBlock_px};
}

/// Of an image of that size.
[[nodiscard]] BlockMap all_blocks(const image::Size& size);

/// `mask`: the rope's share of each pixel of a region.
[[nodiscard]] BlockMap blocks_near(const image::Image<float>& mask);

/// Of a block that the mask covers: which of the blocks around it, itself in the middle, row by
/// row, hold a pixel near the mask in it.
using NearBlock = std::array<bool, 9>;

/// `mask` [kBlock_px, kBlock_px].
[[nodiscard]] NearBlock near_block(const float* mask);

/// `near`: of each of `all` blocks of a region.
[[nodiscard]] BlockMap blocks_near(const BlockMap& all, const std::vector<NearBlock>& near);

/// The blocks of `map` that are `wanted` alone, by their column and row.
[[nodiscard]] BlockMap those(const BlockMap& map,
                             const std::function<bool(const image::Point&)>& wanted);

/// The blocks of `map` within `part`, columns and rows, alone.
[[nodiscard]] BlockMap cut(const BlockMap& map, const image::Rect& part);

}  // namespace flowdlo::field
