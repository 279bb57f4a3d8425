// BlockImage: an image of a region of which only the blocks near the mask are stored: a thin rope,
// magnified, would otherwise take a hundred times its area of memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "field/block_map.hpp"
#include "image/image.hpp"

namespace flowdlo::field {

/// A handle, as image::Image is. Pixels of blocks that are not stored are T{} for whoever reads
/// them, and nobody may change them.
template <class T>
class BlockImage {
 public:
  BlockImage() = default;
  /// All blocks, and the same everywhere. Throws std::bad_alloc, as the others do.
  BlockImage(const image::Size& size, const T& value)
      : BlockImage(size, std::make_shared<const BlockMap>(all_blocks(size)), value) {}
  BlockImage(const image::Size& size, std::shared_ptr<const BlockMap> map, const T& value)
      : BlockImage(over(size, std::move(map))) {
    fill(value);
  }
  explicit BlockImage(const image::Image<const T>& whole)
      : BlockImage(over(whole.size(), std::make_shared<const BlockMap>(all_blocks(whole.size())))) {
    for (int v = 0; v < height(); ++v) {
      for (int u = 0; u < width(); ++u) at(v, u) = whole.at(v, u);
    }
  }

  /// The blocks of `map`, of an image of `size`, whose pixels nobody has set yet.
  static BlockImage over(const image::Size& size, std::shared_ptr<const BlockMap> map) {
    BlockImage result;
    result.size_ = size;
    result.pixels_ = std::make_shared_for_overwrite<T[]>(map->blocks.size() * kPixels);
    result.map_ = std::move(map);
    return result;
  }

  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] const image::Size& size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_.empty(); }
  [[nodiscard]] bool contains(const image::Point& p) const {
    return p.x >= 0 && p.y >= 0 && p.x < size_.width && p.y < size_.height;
  }
  [[nodiscard]] const std::shared_ptr<const BlockMap>& map() const { return map_; }

  /// The pixels of block `i` of the map, row by row, [kBlock_px, kBlock_px]; at the right and lower
  /// end of the image some lie beyond it.
  [[nodiscard]] T* block(std::size_t i) { return pixels_.get() + i * kPixels; }
  [[nodiscard]] const T* block(std::size_t i) const { return pixels_.get() + i * kPixels; }

  /// The pixel at row `v` and column `u`; null where it is not stored, or beyond the image.
  [[nodiscard]] const T* find(int v, int u) const {
    return contains({u, v}) ? stored(v, u) : nullptr;
  }
  [[nodiscard]] T* find(int v, int u) { return contains({u, v}) ? stored(v, u) : nullptr; }

  /// The pixels at rows `v` and `v` + 1 and columns `u` and `u` + 1, row by row; as find.
  [[nodiscard]] std::array<const T*, 4> square(int v, int u) const {
    const bool one_block = v >= 0 && u >= 0 && v + 1 < size_.height && u + 1 < size_.width &&
                           v % kBlock_px + 1 < kBlock_px && u % kBlock_px + 1 < kBlock_px;
    if (!one_block) return {find(v, u), find(v, u + 1), find(v + 1, u), find(v + 1, u + 1)};
    const T* const first = stored(v, u);
    if (first == nullptr) return {};
    return {first, first + 1, first + kBlock_px, first + kBlock_px + 1};
  }

  /// Of a pixel of the image.
  [[nodiscard]] const T& at(int v, int u) const {
    static const T kNone{};
    const T* const found = stored(v, u);
    return found != nullptr ? *found : kNone;
  }
  /// Of a pixel that is stored.
  [[nodiscard]] T& at(int v, int u) { return *stored(v, u); }

  /// visit(row, first column, pixels, how many) for the image's stored pixels, row by row and from
  /// left to right.
  template <class Visit>
  void for_rows(const Visit& visit) const {
    if (!map_) return;
    const auto& blocks = map_->blocks;
    for (std::size_t first = 0; first < blocks.size();) {
      std::size_t last = first;
      while (last < blocks.size() && blocks[last].y == blocks[first].y) ++last;
      const int top = blocks[first].y * kBlock_px;
      for (int v = top; v < std::min(top + kBlock_px, height()); ++v) {
        for (std::size_t i = first; i < last; ++i) {
          const int left = blocks[i].x * kBlock_px;
          visit(v, left, block(i) + (v - top) * kBlock_px, std::min(kBlock_px, width() - left));
        }
      }
      first = last;
    }
  }

  void fill(const T& value) {
    if (map_) std::fill_n(pixels_.get(), map_->blocks.size() * kPixels, value);
  }

  /// Every pixel of the image.
  [[nodiscard]] image::Image<T> whole() const {
    image::Image<T> result(size_, T{});
    for_rows([&](int v, int u, const T* from, int count) {
      std::copy_n(from, count, result.row(v) + u);
    });
    return result;
  }

 private:
  static constexpr std::size_t kPixels = std::size_t{kBlock_px} * kBlock_px;

  [[nodiscard]] T* stored(int v, int u) const {
    const int i = map_->number_of({u / kBlock_px, v / kBlock_px});
    if (i < 0) return nullptr;
    return pixels_.get() + static_cast<std::size_t>(i) * kPixels +
           static_cast<std::size_t>(v % kBlock_px * kBlock_px + u % kBlock_px);
  }

  image::Size size_;
  std::shared_ptr<const BlockMap> map_;
  std::shared_ptr<T[]> pixels_;
};

}  // namespace flowdlo::field
