#include "field/block_map.hpp"

#include <algorithm>

namespace flowdlo::field {
namespace {

constexpr float kHalf = 0.5F;  // of a pixel, that the mask covers

void number(BlockMap& map) {
  map.index.assign(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows), -1);
  for (std::size_t i = 0; i < map.blocks.size(); ++i) {
    const image::Point& at = map.blocks[i];
    map.index[static_cast<std::size_t>(at.y * map.columns + at.x)] = static_cast<int>(i);
  }
}

}  // namespace

std::array<int, 9> BlockMap::around(std::size_t i) const {
  std::array<int, 9> found{};
  for (int k = 0; k < 9; ++k) {
    const int column = blocks[i].x + k % 3 - 1;
    const int row = blocks[i].y + k / 3 - 1;
    const bool inside = column >= 0 && row >= 0 && column < columns && row < rows;
    found[static_cast<std::size_t>(k)] =
        inside ? index[static_cast<std::size_t>(row * columns + column)] : -1;
  }
  return found;
}

BlockMap all_blocks(const image::Size& size) {
  BlockMap map;
  map.columns = (size.width + kBlock_px - 1) / kBlock_px;
  map.rows = (size.height + kBlock_px - 1) / kBlock_px;
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.columns; ++x) map.blocks.push_back({x, y});
  }
  number(map);
  return map;
}

NearBlock near_block(const float* mask) {
  NearBlock near{};
  for (int v = 0; v < kBlock_px; ++v) {
    for (int u = 0; u < kBlock_px; ++u) {
      if (mask[v * kBlock_px + u] <= kHalf) continue;
      const int top = v < kNear_px ? 0 : 1;
      const int bottom = v + kNear_px < kBlock_px ? 1 : 2;
      const int left = u < kNear_px ? 0 : 1;
      const int right = u + kNear_px < kBlock_px ? 1 : 2;
      for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) near[static_cast<std::size_t>(3 * y + x)] = true;
      }
    }
  }
  return near;
}

BlockMap blocks_near(const BlockMap& all, const std::vector<NearBlock>& near) {
  std::vector<char> wanted(all.blocks.size(), 0);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto around = all.around(i);
    for (std::size_t k = 0; k < around.size(); ++k) {
      if (near[i][k] && around[k] >= 0) wanted[static_cast<std::size_t>(around[k])] = 1;
    }
  }
  return those(all, [&](const image::Point& block) {
    return wanted[static_cast<std::size_t>(block.y * all.columns + block.x)] != 0;
  });
}

BlockMap blocks_near(const image::Image<float>& mask) {
  const BlockMap all = all_blocks(mask.size());
  std::vector<NearBlock> near;
  for (const image::Point& block : all.blocks) {
    std::array<float, kBlock_px * kBlock_px> shares{};
    const image::Rect part = pixels_of(block) & image::all_of(mask.size());
    for (int v = 0; v < part.height; ++v) {
      std::copy_n(mask.row(part.y + v) + part.x, part.width, shares.data() + v * kBlock_px);
    }
    near.push_back(near_block(shares.data()));
  }
  return blocks_near(all, near);
}

BlockMap those(const BlockMap& map, const std::function<bool(const image::Point&)>& wanted) {
  BlockMap result{map.columns, map.rows, {}, {}};
  std::copy_if(map.blocks.begin(), map.blocks.end(), std::back_inserter(result.blocks), wanted);
  number(result);
  return result;
}

BlockMap cut(const BlockMap& map, const image::Rect& part) {
  return those(map, [&](const image::Point& block) { return part.contains(block); });
}

}  // namespace flowdlo::field
