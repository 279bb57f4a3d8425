// Components: the connected pieces of a mask.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.hpp"

namespace flowdlo::image {

enum class Neighbours { kFour, kEight };

struct Component {
  int area = 0;  ///< pixels
  Rect box;
};

struct Components {
  Image<int> labels;              ///< 0 where the mask is empty
  std::vector<Component> pieces;  ///< [labels]; the first is what is empty, without its box

  [[nodiscard]] int count() const { return static_cast<int>(pieces.size()); }
};

/// Pieces are numbered as they come, row by row; those of eight neighbours by pairs of rows and, in
/// a pair, by pairs of columns.
[[nodiscard]] Components components(const Image<const std::uint8_t>& mask, Neighbours neighbours);

/// Each pixel of `mask` becomes what `values` says of its label.
void set_pieces(const Image<const int>& labels, const std::vector<std::uint8_t>& values,
                Mask& mask);

}  // namespace flowdlo::image
