// HostileMask: masks that are no rope, or hardly one, by name: noise, checkers, grids, spirals,
// text, combs, lines, dots, fractals, full ones, several ropes and tangles.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace flowdlo::lab {

/// One mask: what is drawn, how much of it, and on which image.
struct HostileMask {
  std::string_view family;  ///< "noise", "checker", ...
  int amount = 0;           ///< in the family's own unit, see `hostile_mask.cpp`
  cv::Size size_px;

  /// For example "noise_50_640x480".
  [[nodiscard]] std::string name() const;
};

/// The corpus: 40 patterns on five sizes from 64 x 64 to 4096 x 4096, 200 masks, in a fixed order.
[[nodiscard]] std::vector<HostileMask> hostile_corpus();

/// Those of that size that hold no rope: noise, patterns, text, blobs; 30 of them.
[[nodiscard]] std::vector<HostileMask> ropeless_masks(const cv::Size& size_px);

/// The sizes of the corpus, ascending.
[[nodiscard]] std::vector<cv::Size> hostile_sizes();

/// [h, w] u8, 0 or 255; the same for the same mask, always.
[[nodiscard]] cv::Mat draw(const HostileMask& mask);

/// What an ordinary frame of that size holds: one rope along a wave, crossing nothing.
[[nodiscard]] cv::Mat draw_ordinary(const cv::Size& size_px);

}  // namespace flowdlo::lab
