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

BlockMap blocks_near(const image::Image<float>& mask) {
  BlockMap map;
  map.columns = (mask.width() + kBlock_px - 1) / kBlock_px;
  map.rows = (mask.height() + kBlock_px - 1) / kBlock_px;
  std::vector<std::uint8_t> wanted(static_cast<std::size_t>(map.columns) *
                                   static_cast<std::size_t>(map.rows));
  const auto block = [](int px, int most) { return std::clamp(px / kBlock_px, 0, most - 1); };
  for (int v = 0; v < mask.height(); ++v) {
    const auto* row = mask.row(v);
    const int top = block(v - kNear_px, map.rows);
    const int bottom = block(v + kNear_px, map.rows);
    for (int u = 0; u < mask.width(); ++u) {
      if (row[u] <= kHalf) continue;
      const int left = block(u - kNear_px, map.columns);
      const int right = block(u + kNear_px, map.columns);
      for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x)
          wanted[static_cast<std::size_t>(y * map.columns + x)] = 1;
      }
    }
  }
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.columns; ++x) {
      if (wanted[static_cast<std::size_t>(y * map.columns + x)] != 0) map.blocks.push_back({x, y});
    }
  }
  number(map);
  return map;
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
