// Masks: which pixels show the rope, for callers who have a camera but no mask yet.
//
// Each call takes one Frame and looks only at what it names below; Frame::mask and
// Frame::instances are never read and may be empty. What comes back is [height, width], 255 where
// the rope is and 0 elsewhere, ready to be Frame::mask; all 0 where nothing was found. Sizes in
// pixels are those of an image 640 px wide and grow with the width. Every call fails with kBadInput
// and every fault of frame and arguments, or with kOutOfMemory; none throws.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/export.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// [height, width] 255: rope, 0: none.
using Mask = std::vector<std::uint8_t>;

/// What is mended in a mask before it is handed out, in this order.
struct MaskCleaning {
  bool smooth = true;  ///< lone pixels go, and pixels that six neighbours surround are filled
  float fill_holes_px2 = 60;   ///< holes up to this area are filled, 0..1e6; a loop's is larger
  float least_piece_px2 = 60;  ///< pieces below this area are left out, 0..1e6
};

/// A rope's colour as light does not change it: the chromaticity (a/L, b/L) of OKLab, which is the
/// same however brightly the rope is lit. A rope without colour (black, grey, white) differs from a
/// table without colour by its lightness alone: narrow that band, or use mask_from_plane().
struct ColorBand {
  std::uint8_t red = 0;  ///< the rope's colour, sRGB
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  float tolerance = 0.12F;        ///< distance of chromaticities, over 0, at most 2
  float least_lightness = 0.15F;  ///< OKLab's L, 0..1: darker pixels have no colour to go by
  float most_lightness = 1;       ///< the same, 0..1
  MaskCleaning cleaning{};
};

/// Pixels of the band's colour, and those next to them that come within one and a half tolerances.
/// Reads width, height and color_bgr.
[[nodiscard]] FLOWDLO_EXPORT Result<Mask> mask_from_color(const Frame& frame,
                                                          const ColorBand& band);

/// A table, or whatever plane fills most of the depth image.
struct Plane {
  Point3 normal{};       ///< unit length, camera frame, towards the camera
  float distance_m = 0;  ///< from the camera, metres: normal . p = -distance_m on the plane
  float noise_m = 0;     ///< standard deviation of the plane's own pixels about it, metres
  float share = 0;       ///< (0, 1] of the measured pixels that lie on it
};

/// The plane that most measured pixels lie on, by a robust fit. Reads width, height, intrinsics and
/// depth_m. Fails as well where no plane holds 15 % of the measured pixels. The same frame gives
/// the same bits.
[[nodiscard]] FLOWDLO_EXPORT Result<Plane> fit_plane(const Frame& frame);

/// How far above the plane the rope may lie, metres.
struct HeightBand {
  float least_m = 0.003F;  ///< over 0; noise of the depth raises it, see Plane::noise_m
  float most_m = 0.08F;    ///< over least_m, at most 10
  MaskCleaning cleaning{};
};

/// What stands out of fit_plane()'s plane towards the camera by a height within `band`: where
/// least_m is below three standard deviations of the noise, by those. Everything that stands there
/// is found, not the rope alone. Reads what fit_plane() reads, and fails as it does.
[[nodiscard]] FLOWDLO_EXPORT Result<Mask> mask_from_plane(const Frame& frame,
                                                          const HeightBand& band);

/// How a region grows from the pixels that somebody clicked on.
struct SeedGrowth {
  float tolerance = 0.12F;            ///< of chromaticity, as in ColorBand
  float lightness_tolerance = 0.25F;  ///< of OKLab's L, over 0, at most 2
  float depth_step_m = 0.02F;         ///< between neighbours that were measured, over 0, at most 10
  MaskCleaning cleaning{};
};

inline constexpr int kMostSeeds = 256;

/// The pixels that can be reached from a seed over neighbours of its colour, without a step in
/// depth; several seeds give all that any of them reaches. A seed is a pixel inside the image; its
/// colour is the median of the nine pixels around it. Fails as well where the regions of seeds of
/// different colours cover the image four times together. Reads width, height, color_bgr and,
/// unless it is empty, depth_m.
[[nodiscard]] FLOWDLO_EXPORT Result<Mask> mask_from_seeds(const Frame& frame,
                                                          std::span<const Pixel> seeds,
                                                          const SeedGrowth& growth = {});

/// `mask`, [height, width] with the rope over 127, mended. The calls above do this themselves; it
/// is for masks that come from elsewhere, or that are the common part of two.
[[nodiscard]] FLOWDLO_EXPORT Result<Mask> clean_mask(int width, int height,
                                                     std::span<const std::uint8_t> mask,
                                                     const MaskCleaning& cleaning = {});

}  // namespace flowdlo
