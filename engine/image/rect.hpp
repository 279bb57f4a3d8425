// Points, sizes and rectangles of pixels.
#pragma once

#include <algorithm>

namespace flowdlo::image {

struct Point {
  int x = 0;
  int y = 0;

  friend bool operator==(const Point&, const Point&) = default;
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y}; }
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y}; }
  friend Point operator*(int times, const Point& p) { return {times * p.x, times * p.y}; }
};

struct Size {
  int width = 0;
  int height = 0;

  [[nodiscard]] int area() const { return width * height; }
  [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
  friend bool operator==(const Size&, const Size&) = default;
  friend Size operator*(const Size& size, int times) {
    return {times * size.width, times * size.height};
  }
};

/// The pixels from (x, y) to (x + width - 1, y + height - 1).
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] Point corner() const { return {x, y}; }
  [[nodiscard]] Size size() const { return {width, height}; }
  [[nodiscard]] int area() const { return width * height; }
  [[nodiscard]] bool empty() const { return width <= 0 || height <= 0; }
  [[nodiscard]] bool contains(const Point& p) const {
    return x <= p.x && p.x < x + width && y <= p.y && p.y < y + height;
  }
  friend bool operator==(const Rect&, const Rect&) = default;

  /// What both hold; of no size where that is nothing.
  friend Rect operator&(const Rect& a, const Rect& b) {
    const int left = std::max(a.x, b.x);
    const int top = std::max(a.y, b.y);
    const int width = std::min(a.x + a.width, b.x + b.width) - left;
    const int height = std::min(a.y + a.height, b.y + b.height) - top;
    if (width <= 0 || height <= 0) return {};
    return {left, top, width, height};
  }
  friend Rect operator-(const Rect& rect, const Point& by) {
    return {rect.x - by.x, rect.y - by.y, rect.width, rect.height};
  }
};

/// Every pixel of an image of that size.
[[nodiscard]] inline Rect all_of(const Size& size) { return {0, 0, size.width, size.height}; }

/// `rect` with `by` more pixels on every side.
[[nodiscard]] inline Rect grown(const Rect& rect, int by) {
  return {rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by};
}

}  // namespace flowdlo::image
