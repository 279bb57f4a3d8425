// NearestPixels: the exact Euclidean feature transform of a binary image, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace flowdlo::evidence {

struct Pixel {
  std::int32_t u;
  std::int32_t v;
};

/// What a column's nearest set pixel costs, seen from any pixel of one row.
struct Parabola {
  int column;
  std::int64_t offset;  ///< squared vertical distance * 2^22 + index
  int begin;            ///< first u at which it is the lowest
};

class NearestPixels {
 public:
  /// `set` is [height, width], set where not zero; width * height at most 2^22.
  NearestPixels(std::span<const std::uint8_t> set, int width, int height);

  /// [width] the set pixel nearest to the centre of each pixel of row v, Euclidean and exact; ties
  /// go to the upper, then to the left one. Empty when no pixel of the image is set. Overwritten by
  /// the next call. Linear in the width.
  [[nodiscard]] std::span<const Pixel> of_row(int v);

 private:
  int width_;
  std::vector<std::int32_t> rows_;  // [height, width] row of the column's nearest set pixel
  std::vector<Parabola> envelope_;  // [width] room for that of a row
  std::vector<Pixel> nearest_;      // [width] of the row asked for last
};

}  // namespace flowdlo::evidence
