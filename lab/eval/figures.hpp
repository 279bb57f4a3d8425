// Figures: the pictures of chapter 4 from trials.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "eval/trial.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

struct Figure {
  std::string name;   ///< of its file, without the ending
  std::string title;  ///< one line
  std::vector<std::uint8_t> png;
};

/// Figures 4.2 and 4.4, Table 4.5 as a plot and the reliability diagram of every data set, as far
/// as their methods were run. Overlays read the frames again: a frame that has gone is left out.
/// Fails with kInternal.
[[nodiscard]] Result<std::vector<Figure>> figures(std::span<const Trial> trials);

}  // namespace flowdlo::eval
