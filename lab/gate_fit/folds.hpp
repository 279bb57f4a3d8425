// Folds: which scenes a stage is fitted on when its answers to others are asked for.
#pragma once

#include <cstddef>
#include <vector>

namespace flowdlo::lab {

using Indices = std::vector<std::size_t>;

inline constexpr std::size_t kFolds = 5;

/// Every index below `count` that is not of the fold; all of them for fold kFolds.
[[nodiscard]] inline Indices all_but(std::size_t fold, std::size_t count) {
  Indices indices;
  for (std::size_t s = 0; s < count; ++s) {
    if (s % kFolds != fold) indices.push_back(s);
  }
  return indices;
}

/// Calls `work` with each fold's other scenes and its own.
template <class Work>
void each_fold(std::size_t count, const Work& work) {
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    Indices own;
    for (std::size_t s = fold; s < count; s += kFolds) own.push_back(s);
    work(all_but(fold, count), own);
  }
}

}  // namespace flowdlo::lab
