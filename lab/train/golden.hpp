// Golden: what libtorch computes in double precision, kept small enough for the repository, so that
// the engine is checked against it where no libtorch is installed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "train/record.hpp"
#include "weights/variant.hpp"

namespace flowdlo::train {

inline constexpr std::uint64_t kGoldenWeightsSeed = 5;  ///< of weights::seeded
inline constexpr int kGoldenSteps = 4;                  ///< K

/// One variant with seeded weights on the golden record, draw 0 of the source of seed 0.
struct GoldenCase {
  weights::Variant variant;
  std::vector<float> velocity;  ///< [64, 3] at x_0 and t = 0, normalised
  std::vector<float> nodes;     ///< [64, 3] after K steps, camera frame, metres
};

/// Mean and scale that stand in the metadata of the golden weights.
inline constexpr std::array<float, 4> kGoldenNorm{0.01F, -0.02F, 0.42F, 0.12F};

/// A drawn rope in a small image, with depth, and the truth for its prior.
[[nodiscard]] Record golden_record();

/// The variants that the repository keeps.
[[nodiscard]] std::vector<weights::Variant> golden_variants();

/// folder/golden.records and folder/golden.json. Fails with kIo.
[[nodiscard]] Result<void> write_golden(const std::vector<GoldenCase>& cases,
                                        const std::filesystem::path& folder);

/// Fails with kIo or kBadInput.
[[nodiscard]] Result<std::vector<GoldenCase>> read_golden(const std::filesystem::path& folder);

}  // namespace flowdlo::train
