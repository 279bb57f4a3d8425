#include "recording/rectification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "frame/limits.hpp"

namespace flowdlo::recording {
namespace {

enum class Lens { kPinhole, kBrown, kFishEye };

constexpr std::size_t kMostCoefficients = 8;
constexpr double kTiny = 1e-9;

// Coefficients, absent ones 0. Brown: k1 k2 p1 p2 k3 k4 k5 k6; fish eye: k1 k2 k3 k4.
using Coefficients = std::array<double, kMostCoefficients>;

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0; });
}

Result<Lens> lens_of(const CameraMessage& camera, const std::string& who) {
  if (all_zero(camera.d)) return Lens::kPinhole;
  const std::size_t count = camera.d.size();
  const bool finite = std::all_of(camera.d.begin(), camera.d.end(),
                                  [](double value) { return std::isfinite(value); });
  const bool brown = camera.model == "plumb_bob" && (count == 4 || count == 5);
  const bool rational = camera.model == "rational_polynomial" && count == 8;
  const bool fish_eye = (camera.model == "equidistant" || camera.model == "fisheye") && count == 4;
  if (finite && (brown || rational)) return Lens::kBrown;
  if (finite && fish_eye) return Lens::kFishEye;
  return Error{
      ErrorCode::kBadInput,
      fmt::format("{}: expected a distortion of plumb_bob (4 or 5 numbers), "
                  "rational_polynomial (8) or equidistant (4), got \"{}\" with {}; rectify "
                  "the images (image_proc), and say --rectified",
                  who, camera.model, count)};
}

struct Drawn {
  double x = 0;
  double y = 0;
};

// Where the lens draws the ray (x, y, 1).
Drawn drawn(Lens lens, const Coefficients& c, double x, double y) {
  const double r2 = x * x + y * y;
  if (lens == Lens::kFishEye) {
    const double r = std::sqrt(r2);
    if (r < kTiny) return {x, y};
    const double angle = std::atan(r);
    const double a2 = angle * angle;
    const double bent = angle * (1 + a2 * (c[0] + a2 * (c[1] + a2 * (c[2] + a2 * c[3]))));
    return {x * bent / r, y * bent / r};
  }
  const double radial =
      (1 + r2 * (c[0] + r2 * (c[1] + r2 * c[4]))) / (1 + r2 * (c[5] + r2 * (c[6] + r2 * c[7])));
  return {x * radial + 2 * c[2] * x * y + c[3] * (r2 + 2 * x * x),
          y * radial + c[2] * (r2 + 2 * y * y) + 2 * c[3] * x * y};
}

Intrinsics intrinsics_of(double fx, double fy, double cx, double cy) {
  return {static_cast<float>(fx), static_cast<float>(fy), static_cast<float>(cx),
          static_cast<float>(cy)};
}

Result<void> check(const CameraMessage& camera, const std::string& who) {
  const auto fail = [&](const std::string& expected, const std::string& got) {
    return Error{ErrorCode::kBadInput, fmt::format("{}: expected {}, got {}", who, expected, got)};
  };
  const auto side = static_cast<std::uint32_t>(frame::kMaxSide_px);
  if (camera.width < 1 || camera.height < 1 || camera.width > side || camera.height > side) {
    return fail(fmt::format("1 to {} px a side", side),
                fmt::format("{} x {}", camera.width, camera.height));
  }
  if (camera.cropped) {
    return fail("a camera info of the whole image at full resolution",
                "one with binning or a region of interest; record without");
  }
  const auto& k = camera.k;
  const bool usable = k[0] > 0 && k[4] > 0 && std::isfinite(k[0]) && std::isfinite(k[4]) &&
                      std::isfinite(k[2]) && std::isfinite(k[5]);
  if (!usable) return fail("a calibrated camera", "a K without focal lengths; calibrate it");
  if (std::abs(k[1]) > kTiny) return fail("a K without skew", fmt::format("a skew of {}", k[1]));
  return {};
}

/// Whether a place lies so near to an image that a pixel of it counts there; no number does not.
bool touches(const Rectification::Place& at, const image::Size& size) {
  return at.u > -1 && at.u < static_cast<float>(size.width) && at.v > -1 &&
         at.v < static_cast<float>(size.height);
}

support::Color bilinear(const support::Picture& image, const Rectification::Place& at) {
  const float left = std::floor(at.u);
  const float top = std::floor(at.v);
  const float right_share = at.u - left;
  const float lower_share = at.v - top;
  const image::Rect whole = image::all_of(image.size());
  std::array<float, 3> sums{};
  for (int below = 0; below < 2; ++below) {
    for (int beside = 0; beside < 2; ++beside) {
      const image::Point p{static_cast<int>(left) + beside, static_cast<int>(top) + below};
      if (!whole.contains(p)) continue;
      const float share = (beside != 0 ? right_share : 1 - right_share) *
                          (below != 0 ? lower_share : 1 - lower_share);
      const support::Color& color = image.at(p);
      for (std::size_t c = 0; c < 3; ++c) sums[c] += share * static_cast<float>(color[c]);
    }
  }
  support::Color mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    mean[c] = static_cast<std::uint8_t>(std::min(std::lrint(sums[c]), 255L));
  }
  return mean;
}

/// [h, w] of `map`: what `value_at` says of each place that touches `image`; elsewhere 0.
template <class Pixel, class ValueAt>
image::Image<Pixel> moved(const image::Image<Pixel>& image,
                          const image::Image<Rectification::Place>& map, ValueAt value_at) {
  image::Image<Pixel> result(map.size(), Pixel{});
  for (std::size_t i = 0; i < result.total(); ++i) {
    const Rectification::Place& at = map.data()[i];
    if (touches(at, image.size())) result.data()[i] = value_at(image, at);
  }
  return result;
}

template <class Pixel>
Pixel nearest_in(const image::Image<Pixel>& image, const Rectification::Place& at) {
  const image::Point p{static_cast<int>(std::lrint(at.u)), static_cast<int>(std::lrint(at.v))};
  return image::all_of(image.size()).contains(p) ? image.at(p) : Pixel{};
}

}  // namespace

Result<Rectification> Rectification::create(const CameraMessage& camera, bool rectified,
                                            const std::string& who) {
  if (auto sound = check(camera, who); !sound) return sound.error();
  Rectification result;
  result.size_ = {static_cast<int>(camera.width), static_cast<int>(camera.height)};
  const auto& k = camera.k;
  const auto& p = camera.p;
  result.intrinsics_ = intrinsics_of(k[0], k[4], k[2], k[5]);
  if (rectified) {
    if (p[0] > 0 && p[5] > 0) result.intrinsics_ = intrinsics_of(p[0], p[5], p[2], p[6]);
    return result;
  }
  const auto lens = lens_of(camera, who);
  if (!lens) return lens.error();
  if (*lens == Lens::kPinhole) return result;
  Coefficients coefficients{};
  std::copy(camera.d.begin(), camera.d.end(), coefficients.begin());
  result.map_ = image::Image<Place>(result.size_);
  for (int v = 0; v < result.size_.height; ++v) {
    for (int u = 0; u < result.size_.width; ++u) {
      const auto at = drawn(*lens, coefficients, (u - k[2]) / k[0], (v - k[5]) / k[4]);
      const double from_u = k[0] * at.x + k[2];
      const double from_v = k[4] * at.y + k[5];
      result.map_.at(v, u) = {static_cast<float>(from_u), static_cast<float>(from_v)};
      const double shift = std::hypot(from_u - u, from_v - v);
      result.largest_shift_px_ = std::max(result.largest_shift_px_, shift);
    }
  }
  return result;
}

Rectification::Place Rectification::source(int u, int v) const {
  if (map_.empty()) return {static_cast<float>(u), static_cast<float>(v)};
  return map_.at(v, u);
}

support::Picture Rectification::color(const support::Picture& image) const {
  return map_.empty() ? image : moved(image, map_, bilinear);
}

image::Image<float> Rectification::nearest(const image::Image<float>& depth_m) const {
  return map_.empty() ? depth_m : moved(depth_m, map_, nearest_in<float>);
}

image::Mask Rectification::nearest(const image::Mask& mask) const {
  return map_.empty() ? mask : moved(mask, map_, nearest_in<std::uint8_t>);
}

}  // namespace flowdlo::recording
