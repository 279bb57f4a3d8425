// Precision: what a model in training computes in. Its weights, its norms' statistics and its loss
// are f32.
#pragma once

#include <utility>
#include <vector>

namespace flowdlo::train {

enum class Precision { kF32, kBf16 };

/// As recipes spell it.
[[nodiscard]] inline const std::vector<std::pair<const char*, Precision>>& precisions() {
  static const std::vector<std::pair<const char*, Precision>> names{{"f32", Precision::kF32},
                                                                    {"bf16", Precision::kBf16}};
  return names;
}

}  // namespace flowdlo::train
