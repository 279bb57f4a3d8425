// Sight: what a camera shows of a region, and what of it the network is given.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "field/block_image.hpp"
#include "field/block_map.hpp"
#include "field/region.hpp"
#include "flowdlo/frame.hpp"
#include "image/image.hpp"
#include "threads/pool.hpp"

namespace flowdlo::field {

using Color = std::array<float, 3>;

/// Images of one size.
struct Sight {
  image::Image<Color> color;    ///< BGR, 0 to 1; empty: none, or one colour everywhere
  image::Image<float> mask;     ///< 0 to 1: share of the pixel that the mask covers
  image::Image<float> depth_m;  ///< 0: none
  image::Image<float> inside;   ///< 1 within the camera's image, 0 beyond
  float focal_px = 0;           ///< fx in pixels of this image
};

/// Of the whole region. Expects a valid frame.
[[nodiscard]] Sight look(const Frame& frame, const Region& region);

/// What a Sight holds of one pixel; eight values, for processors like those.
enum Seen { kSeenBlue, kSeenGreen, kSeenRed, kSeenMask, kSeenDepth, kSeenInside };
using SeenPixel = std::array<float, 8>;

/// A Sight near the mask alone.
struct NearSight {
  BlockImage<SeenPixel> pixels;
  bool has_color = false;
  float focal_px = 0;
};

/// The blocks of a region near the frame's mask; `pool` as threads::share_out has it.
[[nodiscard]] BlockMap blocks_near(const Frame& frame, const Region& region,
                                   threads::Pool* pool = nullptr);

/// Of these blocks. Expects a valid frame.
[[nodiscard]] NearSight look(const Frame& frame, const Region& region,
                             std::shared_ptr<const BlockMap> blocks, threads::Pool* pool = nullptr);

/// Planes of the network's input, in this order.
enum Plane {
  kBlue,      ///< less the rope's median, over twice the rope's spread; within 3 either way
  kGreen,     ///< likewise
  kRed,       ///< likewise
  kHasColor,  ///< 1 or 0
  kDepth,     ///< less the depth of the rope around, in units of two rope widths; likewise
  kHasDepth,  ///< 1 or 0
  kMask,      ///< 0 to 1
  kPlanes
};

using PlanesOfPixel = std::array<float, kPlanes>;
using Planes = image::Image<PlanesOfPixel>;

/// What the network is given: the same for every rope, camera and distance as far as that can be
/// had. Beyond the camera's image all planes are 0.
class Input {
 public:
  /// Of a sight, which has to outlive it.
  explicit Input(const NearSight& sight);

  /// `to` [kBlock_px, kBlock_px]: the planes of a block of the sight, by its number.
  void planes_of(std::size_t block, PlanesOfPixel* to) const;

 private:
  struct Scales;

  const NearSight& sight_;
  std::shared_ptr<const Scales> scales_;
};

/// The same of a whole sight.
[[nodiscard]] Planes input_of(const Sight& sight);

}  // namespace flowdlo::field
