// Refined: a hypothesis with its nodes where the refining networks see the rope's axis and tips.
#pragma once

#include <array>

#include "field/view.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "refine/network.hpp"

namespace flowdlo::refine {

/// A node is moved no farther than this, deep and aside, radii.
inline constexpr float kMostOffset = 2;

struct Refined {
  Centerline nodes{};
  std::array<float, 2> beyond_m{0, 0};  ///< by which it is longer at either end; negative: shorter
};

/// The curve's nodes, each moved deep and aside, then its ends moved along to where the tips are
/// (refine/tips.hpp), and 64 nodes again evenly between them. `seen`: what the strand field shows;
/// null, or a network without tips: the ends stay where they are. All stay where the curve makes no
/// strip, and a node where it would not be finite and in front of the camera. Fails as Network::see
/// does.
[[nodiscard]] Result<Refined> refined(const Curve& curve, const Frame& frame, Network& network,
                                      const field::FieldView* seen = nullptr);

}  // namespace flowdlo::refine
