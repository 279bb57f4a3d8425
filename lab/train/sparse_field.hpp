// SparseField: evidence::MaskField evaluated only where it is read.
//
// A training sample reads the field at 64 nodes; laying all of it out costs a hundred times more.
// Mask share and displacement are the engine's exactly; the smoothed mask agrees to 1e-6 (its sums
// run in another order).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "train/mask_runs.hpp"

namespace flowdlo::train {

class SparseField {
 public:
  /// Takes over another mask; keeps its memory.
  void reset(const MaskRuns& mask);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// The field's four channels at one of its pixels.
  [[nodiscard]] std::array<float, 4> texel(int row, int column) const;

 private:
  [[nodiscard]] float share(int row, int column) const {
    return share_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)];
  }
  void fill_share(const MaskRuns& mask);
  void collect_border();
  [[nodiscard]] float smoothed(int row, int column) const;
  [[nodiscard]] std::array<float, 2> displacement(int row, int column) const;

  int width_ = 0;
  int height_ = 0;
  std::vector<float> share_;     // [height, width]
  std::vector<float> border_u_;  // set pixels with an unset or missing neighbour, row-major order
  std::vector<float> border_v_;
};

}  // namespace flowdlo::train
