// Scene: a random rope of a wanted kind, seen by a camera, with the truth beside it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "scene/render.hpp"

namespace flowdlo::lab {

enum class Kind {
  kSimple,         ///< on a table, no crossing
  kHanging,        ///< in free air, no crossing
  kOneCrossing,    ///< on a table
  kManyCrossings,  ///< 2 to 6 on a table
  kHangingLoops,   ///< in free air, 1 to 2 crossings
  kOccluder,       ///< one or two bars in front hide up to a quarter
  kThin,           ///< 2 to 8 pixels wide
  kRagged,         ///< the mask bleeds onto the background and is frayed
  kBadDepth,       ///< holes, flying pixels, strong noise
  kTouching,       ///< a hairpin whose strands touch
  kCoil,           ///< a flat coil of 2 to 3 turns
};

inline constexpr int kKinds = 11;

[[nodiscard]] std::string_view name_of(Kind kind);
/// In the order of the enumerators.
[[nodiscard]] std::span<const std::string_view> kind_names();
[[nodiscard]] std::optional<Kind> kind_of(std::string_view name);

struct Scene {
  Kind kind = Kind::kSimple;
  Image image;
  Curve3 curve;        ///< the whole centerline, camera frame, dense
  Centerline truth{};  ///< 64 nodes of it, uniform in arclength
  double radius_m = 0;
  std::vector<Bar> bars;

  /// Views into this object.
  [[nodiscard]] Frame frame() const {
    return {image.width, image.height, image.camera, image.depth_m, image.mask, image.color_bgr};
  }
};

/// Deterministic: the same kind and seed give the same scene.
[[nodiscard]] Scene make_scene(Kind kind, std::uint64_t seed);

}  // namespace flowdlo::lab
