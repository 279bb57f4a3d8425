// Gather: samples of many synthetic frames, kept in files between runs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "gate/fitted.hpp"
#include "gate_fit/sample.hpp"
#include "weights/field_weights.hpp"
#include "weights/weights.hpp"

namespace flowdlo::lab {

inline constexpr std::uint64_t kFirstUntrained = 1000000;  ///< training takes scenes from the front

struct GatherConfig {
  std::string weights;         ///< of the model, .fdw
  std::string field;           ///< of a strand field, .safetensors; empty: none
  std::string cache;           ///< begins the names of files to go on from; empty: keep nothing
  std::string split = "wide";  ///< or "thesis"
  std::string part = "training";
  std::uint64_t first = kFirstUntrained;  ///< index of the first scene of `split`
  int threads = 1;                        ///< of the model; 0: one a core
  int draws = 4;
  int steps = 10;
  bool quiet = false;      ///< no progress bar
  bool unrefined = false;  ///< nodes stay where the prior has them
};

/// The weights that a configuration names, and the gate that is fitted to them so far.
struct Model {
  std::shared_ptr<const weights::Weights> weights;
  std::shared_ptr<const weights::FieldWeights> field;  ///< null: none
  std::optional<gate::Fitted> fitted;                  ///< none: nothing is sure
};

/// Fails as loading weights does.
[[nodiscard]] Result<Model> open_model(const GatherConfig& config);

using Samples = std::vector<GateSample>;

/// So many scenes of the split, the model's draws among their candidates.
[[nodiscard]] Result<Samples> with_model(const GatherConfig& config, int scenes);

/// Others of the split, priors alone. Some come without a picture, some with depth on the mask
/// alone, some with neither: what a strand field says of them is weighed as well.
[[nodiscard]] Result<Samples> without_model(const GatherConfig& config, int scenes);

/// What that many such scenes lack: clean depth on a table, so that what is sure counts as well;
/// tubes before nothing, so that a frame counts that shows no more than a rope; several ropes in
/// one mask, rendered and drawn, so that no confidence is left for them; depth as a stereo camera
/// matches it; rings, which no scene of one rope has.
[[nodiscard]] Result<Samples> beside_split(const GatherConfig& config, int scenes);

}  // namespace flowdlo::lab
