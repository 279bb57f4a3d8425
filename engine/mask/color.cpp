// mask_from_color: pixels of a rope's chromaticity.
#include <cstddef>
#include <utility>

#include "guard/guarded.hpp"
#include "mask/checks.hpp"
#include "mask/cleaning.hpp"
#include "mask/perceptual.hpp"
#include "mask/regions.hpp"

namespace flowdlo {
namespace mask {
namespace {

constexpr float kMostTolerance = 2;      ///< no two colours are farther apart
constexpr float kWeakTolerances = 1.5F;  ///< how far a pixel beside the rope may be, tolerances

Result<Mask> by_color(const Frame& frame, const ColorBand& band) {
  Checks checks("mask_from_color");
  checks.size(frame.width, frame.height);
  checks.color(frame);
  checks.positive("ColorBand.tolerance", band.tolerance, kMostTolerance);
  checks.within("ColorBand.least_lightness", band.least_lightness, 0, 1);
  checks.within("ColorBand.most_lightness", band.most_lightness, 0, 1);
  checks.cleaning(band.cleaning);
  if (auto fine = checks.outcome(); !fine) return fine.error();
  const Perceived rope = perceived(band.red, band.green, band.blue);
  const float strong = band.tolerance * band.tolerance;
  const float weak = strong * kWeakTolerances * kWeakTolerances;
  Perceiver perceiver;
  std::vector<Fit> fits(frame.color_bgr.size() / 3, Fit::kNot);
  for (std::size_t pixel = 0; pixel < fits.size(); ++pixel) {
    const Perceived& color = perceiver(&frame.color_bgr[3 * pixel]);
    if (color.lightness < band.least_lightness || color.lightness > band.most_lightness) continue;
    const float apart = chromatic_distance2(color, rope);
    if (apart <= weak) fits[pixel] = apart <= strong ? Fit::kStrong : Fit::kWeak;
  }
  const Size size{frame.width, frame.height};
  return cleaned(connected_to_strong(fits, size), size, band.cleaning);
}

}  // namespace
}  // namespace mask

Result<Mask> mask_from_color(const Frame& frame, const ColorBand& band) {
  return guard::guarded("mask_from_color", [&] { return mask::by_color(frame, band); });
}

}  // namespace flowdlo
