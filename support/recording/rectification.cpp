#include "recording/rectification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

// Where the lens draws the ray (x, y, 1).
cv::Point2d drawn(Lens lens, const Coefficients& c, double x, double y) {
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
  result.map_.create(result.size_, CV_32FC2);
  for (int v = 0; v < result.size_.height; ++v) {
    for (int u = 0; u < result.size_.width; ++u) {
      const auto at = drawn(*lens, coefficients, (u - k[2]) / k[0], (v - k[5]) / k[4]);
      const cv::Point2d from(k[0] * at.x + k[2], k[4] * at.y + k[5]);
      result.map_.at<cv::Vec2f>(v, u) = {static_cast<float>(from.x), static_cast<float>(from.y)};
      const double shift = std::hypot(from.x - u, from.y - v);
      result.largest_shift_px_ = std::max(result.largest_shift_px_, shift);
    }
  }
  return result;
}

cv::Mat Rectification::color(const cv::Mat& image) const {
  if (map_.empty()) return image;
  cv::Mat result;
  cv::remap(image, result, map_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return result;
}

cv::Mat Rectification::nearest(const cv::Mat& image) const {
  if (map_.empty()) return image;
  cv::Mat result;
  cv::remap(image, result, map_, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
  return result;
}

}  // namespace flowdlo::recording
