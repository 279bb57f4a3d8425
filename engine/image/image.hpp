// Image: pixels of one type in rows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "image/rect.hpp"

namespace flowdlo::image {

/// A handle: copies and parts share their pixels, `clone` has its own. Whoever holds a const one
/// does not change them. Places are given by row and column.
template <class T>
class Image {
 public:
  Image() = default;

  /// Pixels that nobody has set yet. Throws std::bad_alloc.
  explicit Image(const Size& size) : size_(size.empty() ? Size{} : size), stride_(size_.width) {
    if (size_.empty()) return;
    auto pixels = std::make_shared_for_overwrite<T[]>(total());
    first_ = pixels.get();
    owner_ = std::move(pixels);
  }
  Image(const Size& size, const T& value) : Image(size) { fill(value); }

  /// Over pixels that are somebody else's: `owner` keeps them, or they outlive the image.
  /// `stride`: pixels from one row to the next.
  Image(T* first, const Size& size, std::ptrdiff_t stride,
        std::shared_ptr<const void> owner = nullptr)
      : size_(size), stride_(stride), first_(first), owner_(std::move(owner)) {}

  /// Of the same pixels, as ones that do not change.
  template <class U>
  requires std::is_same_v<const U, T> Image(
      const Image<U>& other)  // NOLINT(google-explicit-constructor)
      : Image(other.data(), other.size(), other.stride(), other.owner()) {}

  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] const Size& size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_.empty(); }
  [[nodiscard]] std::size_t total() const {
    return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height);
  }
  /// Pixels from one row to the next; as many as a row has where nothing lies between rows.
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] const std::shared_ptr<const void>& owner() const { return owner_; }

  [[nodiscard]] T* data() { return first_; }
  [[nodiscard]] const T* data() const { return first_; }
  [[nodiscard]] T* row(int v) { return first_ + v * stride_; }
  [[nodiscard]] const T* row(int v) const { return first_ + v * stride_; }
  [[nodiscard]] T& at(int v, int u) { return row(v)[u]; }
  [[nodiscard]] const T& at(int v, int u) const { return row(v)[u]; }
  [[nodiscard]] T& at(const Point& p) { return row(p.y)[p.x]; }
  [[nodiscard]] const T& at(const Point& p) const { return row(p.y)[p.x]; }

  /// The pixels of `rect`, which lies within the image.
  [[nodiscard]] Image part(const Rect& rect) const {
    return {first_ + rect.y * stride_ + rect.x, rect.size(), stride_, owner_};
  }

  [[nodiscard]] Image<std::remove_const_t<T>> clone() const {
    Image<std::remove_const_t<T>> copy(size_);
    for (int v = 0; v < height(); ++v) std::copy_n(row(v), width(), copy.row(v));
    return copy;
  }

  void fill(const T& value) {
    for (int v = 0; v < height(); ++v) std::fill_n(row(v), width(), value);
  }

 private:
  Size size_;
  std::ptrdiff_t stride_ = 0;
  T* first_ = nullptr;
  std::shared_ptr<const void> owner_;
};

/// Set where it is not 0.
using Mask = Image<std::uint8_t>;

}  // namespace flowdlo::image
