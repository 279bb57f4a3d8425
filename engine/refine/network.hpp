// Network: what the refining network makes of a strip, on any back end.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flowdlo/result.hpp"
#include "ops/program.hpp"
#include "refine/strip.hpp"
#include "refine/tips.hpp"
#include "weights/refine_weights.hpp"
#include "weights/tip_weights.hpp"

namespace flowdlo::refine {

using ProgramFactory = std::function<std::unique_ptr<ops::Program>()>;

/// Where the rope's axis lies beside a node, radii.
struct Offset {
  float deep = 0;
  float aside = 0;
  float laid = 0;  ///< [0, 1] how much of the way to the table (Strip::table_share) it goes besides
};

/// A strip is an image of 64 x 4 places, nodes by their stations: convolutions of 3 x 3 mix
/// neighbours of both. What a node's stations say is averaged.
class Network {
 public:
  /// `tips`: of the network that finds tips; nothing: none does. Fails as ops::Program::build does.
  [[nodiscard]] static Result<Network> create(
      const weights::RefineWeights& weights, const ProgramFactory& make_program,
      const std::optional<weights::TipWeights>& tips = std::nullopt);

  /// Null where there is none.
  [[nodiscard]] const TipNetwork* tips() const { return tips_.get(); }

  /// Fails with kDeviceLost.
  [[nodiscard]] Result<std::array<Offset, kNodes>> see(const Strip& strip);

 private:
  Network() = default;

  std::unique_ptr<const TipNetwork> tips_;
  std::unique_ptr<ops::Program> program_;
  ops::Tensor map_;
  ops::Tensor input_;
  ops::Tensor output_;
  std::vector<float> map_values_;
  std::vector<float> values_;
};

}  // namespace flowdlo::refine
