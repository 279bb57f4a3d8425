// Refined: a hypothesis with its nodes where the refining networks see the rope's axis and tips.
#pragma once

#include <array>
#include <optional>

#include "field/view.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "refine/network.hpp"

namespace flowdlo::refine {

/// A node is moved no farther than this, deep and aside, radii, beside its way to the table.
inline constexpr float kMostOffset = 2;

struct Refined {
  Centerline nodes{};
  std::array<float, 2> beyond_m{0, 0};  ///< by which it is longer at either end; negative: shorter
};

/// What the ends of a curve are moved by.
struct EndsKnown {
  const field::FieldView* seen = nullptr;  ///< what the strand field shows; null: they stay
  double rope_length_m = 0;                ///< known length; 0: unknown
  /// How far beyond either end the tip is known to be, metres; negative: before it.
  std::array<std::optional<float>, 2> tip_m{};
};

/// `nodes`, the curve's or those moved deep and aside, with their ends moved along to where the
/// tips are, as refined() has it.
[[nodiscard]] Refined with_tips(const Curve& curve, const Centerline& nodes, const Frame& frame,
                                const Network& network, const EndsKnown& ends);

/// The curve's nodes, each moved deep and aside, then its ends moved along to where the tips are
/// (refine/tips.hpp) or are known to be, and 64 nodes again evenly between them. What a known
/// length lacks then, both are longer by, above all the one at which the field shows less of a tip,
/// unless both tips are known. A network without tips leaves the other ends where they are. All
/// stay where the curve makes no strip, and where a node would not be finite and in front of the
/// camera. Fails as Network::see does.
[[nodiscard]] Result<Refined> refined(const Curve& curve, const Frame& frame, Network& network,
                                      const EndsKnown& ends = {});

}  // namespace flowdlo::refine
