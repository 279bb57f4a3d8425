// Ropes: a scene of several ropes on a table or in the air, with the truth of each beside it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "scene/render.hpp"

namespace flowdlo::lab {

enum class RopesKind {
  kCrossing,  ///< ropes of one colour and width on a table, the mask whole
  kColored,   ///< each rope of its own colour and its own width
  kHanging,   ///< in free air, one before the other
  kTouching,  ///< two of them run along each other for a while
  kRings,     ///< one of them is a ring without ends
  kLeaving,   ///< the image ends before some of them do
  kGaps,      ///< masks drawn on top of each other: 1 to 3 pixels are missing beside the upper one
};

inline constexpr int kRopesKinds = 7;

[[nodiscard]] std::string_view name_of(RopesKind kind);
[[nodiscard]] std::optional<RopesKind> ropes_kind_of(std::string_view name);

/// One rope of a scene, as far as the image shows it.
struct SeenRope {
  Curve3 curve;                    ///< camera frame, dense; of a ring the last point is the first
  std::array<Curve3, 2> unseen{};  ///< how it goes on before and after `curve`, hidden or outside
  Centerline truth{};              ///< 64 nodes of it, uniform in arclength
  double radius_m = 0;
  bool closed = false;
};

struct RopesScene {
  Image image;  ///< `instances` of it are the true labels, from 1 in the order of `ropes`
  std::vector<SeenRope> ropes;

  /// Views into this object; the labels only where they are asked for.
  [[nodiscard]] Frame frame(bool labels = false) const {
    Frame frame{image.width,   image.height, image.camera,
                image.depth_m, image.mask,   image.color_bgr};
    if (labels) frame.instances = image.instances;
    return frame;
  }
};

/// A scene of `ropes` ropes, 2 at least. Deterministic: the same kind, number and seed give the
/// same scene.
[[nodiscard]] RopesScene make_ropes(RopesKind kind, int ropes, std::uint64_t seed);

}  // namespace flowdlo::lab
