// Sample: the candidates of one synthetic frame, beside the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "field/network.hpp"
#include "flow/sampler.hpp"
#include "flowdlo/hints.hpp"
#include "gate/candidate.hpp"
#include "gate/fitted.hpp"
#include "refine/network.hpp"
#include "synth/synthetic_frame.hpp"
#include "weights/variant.hpp"

namespace flowdlo::lab {

struct GateSample {
  std::uint64_t index = 0;
  std::string scenario;
  bool easy = false;
  bool hard = false;
  bool several = false;                     ///< ropes lie in the mask, and no candidate is right
  Centerline truth{};                       ///< canonical direction; of a ring the beginning that
                                            ///< is nearest to what is returned first
  std::vector<gate::Candidate> candidates;  ///< as estimator::list_candidates lists them
  std::vector<Centerline> refined;  ///< [candidates] what is returned of each; empty: its own nodes
  std::vector<std::uint8_t> doubted;  ///< [candidates] 1: gate::one_rope doubts it; empty: unknown

  /// What is returned where candidate `i` is chosen.
  [[nodiscard]] const Centerline& answer(std::size_t i) const {
    return refined.empty() ? candidates[i].nodes : refined[i];
  }
};

/// Nothing where the engine finds no path or the device fails. Priors alone where `sampler` is
/// null, without a strand field where `field` is, nodes unrefined where `refine` is. Where `fitted`
/// is sure of the first reading, that is all there is; null: it never is. Of `known` the
/// rope's length counts, and whether it is a ring.
[[nodiscard]] std::optional<GateSample> measure(const synth::SyntheticFrame& scene,
                                                flow::Sampler* sampler, field::Network* field,
                                                refine::Network* refine, const gate::Fitted* fitted,
                                                int draws, weights::PriorKind kind,
                                                const Hints& known);

}  // namespace flowdlo::lab
