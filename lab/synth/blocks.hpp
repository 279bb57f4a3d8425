// Blocks: which 4 x 4 pixel blocks of an image can see something, so that no other ray is traced.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "synth/thing.hpp"
#include "synth/view.hpp"

namespace flowdlo::synth {

inline constexpr int kBlock_px = 4;

struct Blocks {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> wanted;  ///< [rows, columns]
};

[[nodiscard]] Blocks blocks_of(const View& view, std::span<const Rope> ropes,
                               std::span<const Thing> things);

}  // namespace flowdlo::synth
