// Sample: what the estimator knows about a scene's traversals, beside the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/ranking.hpp"
#include "prior/prior.hpp"
#include "scene/scene.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {

struct Candidate {
  estimator::Evidence evidence;
  prior::Prior refined;
  double path_score = 0;
  bool right = false;  ///< it visits the rope in order, in either direction; tips may be off
};

/// Candidates in the order of path::trace.
struct Sample {
  std::string kind;  ///< of the scene, or the scenario of a synthetic frame
  std::uint64_t seed = 0;
  std::vector<Candidate> candidates;
  double judging_ms = 0;  ///< lifting and comparing
};

/// Nothing where no path was found or the first could not be lifted.
[[nodiscard]] std::optional<Sample> measure(const Scene& scene, std::uint64_t seed);

/// The same of a synthetic frame. There a candidate is right when no node is astray along the rope
/// and the index error, either way round, stays below a twentieth of the length.
[[nodiscard]] std::optional<Sample> measure(const synth::SyntheticFrame& scene);

}  // namespace flowdlo::lab
