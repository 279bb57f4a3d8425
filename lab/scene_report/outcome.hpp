// SceneOutcome: what one scene's frame gave, beside its truth.
#pragma once

#include <cstdint>

#include "flowdlo/centerline.hpp"
#include "prior/prior.hpp"
#include "scene/scene.hpp"

namespace flowdlo::lab {

struct SceneOutcome {
  Kind kind = Kind::kSimple;
  std::uint64_t seed = 0;
  bool answered = false;         ///< a path was found and lifted; otherwise all below is unset
  bool right = false;            ///< the best traversal visits the rope in order, `follows_rope`
  bool runner_up_right = false;  ///< one of the others does
  bool flipped = false;          ///< the ends are the other way round than the canonical truth's
  double index_cm = 0;           ///< Eq. (4.1), in the better direction; the refined prior's
  double thesis_cm = 0;          ///< the same of the prior of Eq. (3.1)-(3.7), on the same path
  float confidence = 0;
  double path_ms = 0;
  double prior_ms = 0;  ///< lifting and comparing every candidate
  prior::Prior prior;   ///< of the best traversal, refined
  Centerline truth{};   ///< turned to the prior's direction
};

/// Path, priors and confidence as the estimator makes them.
[[nodiscard]] SceneOutcome outcome_of(const Scene& scene, std::uint64_t seed);

}  // namespace flowdlo::lab
