// Sweep: index error against K and D, to find the cheapest pair that loses nothing.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// One pair of K and D over the frames with a truth; an entry a frame, the same frames in each.
struct Setting {
  int steps = 0;
  int draws = 0;
  std::vector<double> model_m;     ///< mean index error of the draws, Eq. (4.1)
  std::vector<double> estimate_m;  ///< index error of the estimate
  std::vector<double> model_ms;    ///< the model's part of the frame

  [[nodiscard]] int evaluations() const { return steps * draws; }
};

/// Runs every pair of `steps` and `draws`, after full's (10, 4), which comes first. `advance` is
/// called once a frame and pair. Frames that give no estimate in some pair are left out of all.
/// Fails as Estimator::create does.
[[nodiscard]] Result<std::vector<Setting>> sweep(const Config& config,
                                                 std::span<const std::filesystem::path> frames,
                                                 std::span<const int> steps,
                                                 std::span<const int> draws,
                                                 const std::function<void()>& advance);

/// How many pairs sweep() runs.
[[nodiscard]] std::size_t settings_of(std::span<const int> steps, std::span<const int> draws);

/// Index of the setting of fewest evaluations that loses nothing against settings[0]: of neither
/// the draws nor the estimate is the mean error larger by more than a hundredth with 95 %
/// confidence (paired bootstrap over frames). 0 when there is none.
[[nodiscard]] std::size_t cheapest(std::span<const Setting> settings);

/// A table in Markdown, ending with the cheapest setting.
[[nodiscard]] std::string sweep_markdown(std::span<const Setting> settings);

}  // namespace flowdlo::eval
