#include "mask/regions.hpp"

#include <utility>

#include "geometry/camera.hpp"

namespace flowdlo::mask {

float area_px2(float area_of_640, const Size& size) {
  const float scale = geometry::pixel_scale(size.width);
  return area_of_640 * scale * scale;
}

Mask connected_to_strong(const std::vector<Fit>& fits, const Size& size) {
  Mask mask(fits.size());
  Places front;
  for (std::size_t pixel = 0; pixel < fits.size(); ++pixel) {
    if (fits[pixel] != Fit::kStrong) continue;
    mask[pixel] = 255;
    front.push_back(static_cast<std::uint32_t>(pixel));
  }
  (void)flood(mask, std::move(front), size,
              [&](std::size_t /*from*/, std::size_t to) { return fits[to] != Fit::kNot; });
  return mask;
}

}  // namespace flowdlo::mask
