// SampleFile: samples kept between runs, one JSON object a line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "gate_fit/sample.hpp"

namespace flowdlo::lab {

/// What the samples of one file have in common; samples of another origin are of no use.
struct SampleOrigin {
  std::string weights_sha256;
  std::string field{};  ///< notes of the strand field's weights; empty: none
  std::string split;
  std::string part;
  std::uint64_t first = 0;
  int draws = 0;
  int steps = 0;

  friend bool operator==(const SampleOrigin&, const SampleOrigin&) = default;
};

struct SampleFile {
  int scenes = 0;  ///< that were measured; those without a path left no sample
  std::vector<GateSample> samples;
};

/// Empty where there is no such file, or where it is of another origin or an older format. Fails
/// with kBadInput where a line is no sample.
[[nodiscard]] Result<SampleFile> read_samples(const std::filesystem::path& file,
                                              const SampleOrigin& origin);

/// Fails with kIo; no partial file stays.
[[nodiscard]] Result<void> write_samples(const std::filesystem::path& file,
                                         const SampleOrigin& origin, const SampleFile& content);

}  // namespace flowdlo::lab
