// fit_plane and mask_from_plane: the table, and what stands on it.
//
// A plane n . p = 1 is linear in 1 / z along the image: 1 / z = n . ray with the ray (x / z, y / z,
// 1) of a pixel, and 1 / z is what stereo and structured light measure with even noise. So the fit
// is linear, and rho = 1 - z n . ray is a pixel's height above the plane as a share of the camera's
// own height 1 / |n|.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "geometry/depth.hpp"
#include "geometry/quantile.hpp"
#include "guard/guarded.hpp"
#include "mask/checks.hpp"
#include "mask/cleaning.hpp"
#include "mask/regions.hpp"
#include "random/philox.hpp"

namespace flowdlo {
namespace mask {
namespace {

/// Of the fit; shares are of z, since rho is one.
struct FitLimits {
  std::size_t samples = 20000;     ///< pixels that are fitted to
  std::size_t voters = 4000;       ///< of them, that judge each trial
  int trials = 2000;               ///< planes through three pixels; 1 fit of 10^3 finds none on a
                                   ///< plane of least_share
  float on_plane = 0.006F;         ///< of z: 4 mm at 0.7 m, twice what such cameras' noise is
  float noise_within = 0.02F;      ///< of z: what is farther off is no noise of the plane
  int refinements = 4;             ///< least squares over the pixels of the last
  float least_on_plane = 0.0015F;  ///< of z: what rounding to millimetres leaves at 0.7 m
  float deviations = 3;            ///< within which a pixel belongs to the plane
  float least_share = 0.15F;       ///< of the measured pixels
  std::size_t least_pixels = 30;
};
constexpr FitLimits kFit;

constexpr float kDeviationsOfNoise = 3;  ///< that a strong pixel stands out by
constexpr float kWeakShare = 0.6F;       ///< of that height, for the pixels beside strong ones
constexpr float kMostHeight_m = 10;
constexpr double kOfDeviation = 1.4826;  ///< median of |x| of a normal variable to its deviation

/// n . p = 1, n in 1 / metres.
struct InverseDepth {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();

  [[nodiscard]] double rho(const Eigen::Vector3d& ray, double z_m) const {
    return 1 - z_m * n.dot(ray);
  }
};

struct Sample {
  Eigen::Vector3d ray;  ///< (x / z, y / z, 1)
  double z_m = 0;
};

Eigen::Vector3d ray_at(std::size_t pixel, const Frame& frame) {
  const auto width = static_cast<std::size_t>(frame.width);
  const auto& camera = frame.intrinsics;
  return {(static_cast<double>(pixel % width) - static_cast<double>(camera.cx)) /
              static_cast<double>(camera.fx),
          (static_cast<double>(pixel / width) - static_cast<double>(camera.cy)) /
              static_cast<double>(camera.fy),
          1};
}

/// So many of `all`, or all of them where there are fewer, evenly over their order.
template <class Value>
std::vector<Value> evenly(const std::vector<Value>& all, std::size_t count) {
  if (all.size() <= count) return all;
  std::vector<Value> some;
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

/// Measured pixels.
std::vector<Sample> samples_of(const Frame& frame) {
  std::vector<std::size_t> measured;
  for (std::size_t pixel = 0; pixel < frame.depth_m.size(); ++pixel) {
    if (geometry::measured(frame.depth_m[pixel])) measured.push_back(pixel);
  }
  std::vector<Sample> samples;
  for (const std::size_t pixel : evenly(measured, kFit.samples)) {
    samples.push_back({ray_at(pixel, frame), static_cast<double>(frame.depth_m[pixel])});
  }
  return samples;
}

/// Through three pixels; none where they lie on a line.
std::optional<InverseDepth> through(const std::vector<Sample>& samples, std::uint64_t trial) {
  const auto words = random::philox(/*seed=*/0, trial);
  Eigen::Matrix3d rays;
  Eigen::Vector3d inverse;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(random::uniform(words[static_cast<std::size_t>(i)]) *
                                             static_cast<double>(samples.size()));
    rays.row(i) = samples[at].ray.transpose();
    inverse[i] = 1 / samples[at].z_m;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(rays);
  if (!solver.isInvertible()) return std::nullopt;
  return InverseDepth{solver.solve(inverse)};
}

/// Of `samples`, not empty, that lie on `plane`.
float share_on(const InverseDepth& plane, const std::vector<Sample>& samples) {
  std::size_t count = 0;
  for (const Sample& one : samples) {
    count += std::abs(plane.rho(one.ray, one.z_m)) <= kFit.on_plane ? 1U : 0U;
  }
  return static_cast<float>(count) / static_cast<float>(samples.size());
}

struct Election {
  InverseDepth plane;
  float share = 0;  ///< of the voters
};

/// Of many planes through three pixels that on which most others lie.
Election elected(const std::vector<Sample>& samples) {
  Election best;
  if (samples.size() < kFit.least_pixels) return best;
  const auto voters = evenly(samples, kFit.voters);
  for (int trial = 0; trial < kFit.trials; ++trial) {
    const auto plane = through(samples, static_cast<std::uint64_t>(trial));
    if (!plane) continue;
    const float share = share_on(*plane, voters);
    if (share > best.share) best = {*plane, share};
  }
  return best;
}

/// Least squares over the pixels within `within` of `plane`.
InverseDepth refitted(const InverseDepth& plane, const std::vector<Sample>& samples,
                      double within) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Sample& one : samples) {
    if (std::abs(plane.rho(one.ray, one.z_m)) > within) continue;
    const Eigen::Vector3d scaled = one.z_m * one.ray;  // rho = 1 - scaled . n
    normal += scaled * scaled.transpose();
    right += scaled;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const Eigen::Vector3d found = solver.solve(right);
  return found.allFinite() ? InverseDepth{found} : plane;
}

/// Deviation of rho on the plane, by the median, which what stands on it hardly moves.
double deviation_of(const InverseDepth& plane, const std::vector<Sample>& samples) {
  std::vector<double> off;
  for (const Sample& one : samples) {
    const double rho = std::abs(plane.rho(one.ray, one.z_m));
    if (rho <= kFit.noise_within) off.push_back(rho);
  }
  return off.empty() ? 0 : kOfDeviation * geometry::median_of(off);
}

struct Fitted {
  InverseDepth inverse;
  double deviation = 0;  ///< of rho
  Plane plane;
};

Result<Fitted> fitted(const Frame& frame, const char* who) {
  const auto samples = samples_of(frame);
  const auto [first, voted] = elected(samples);
  if (samples.size() < kFit.least_pixels || voted < kFit.least_share) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: Frame.depth_m: expected a table that holds {:.0f} % of the "
                             "measured pixels, the best plane holds {:.0f} % of {}; make the mask "
                             "by colour or by seeds",
                             who, 100 * kFit.least_share, 100 * voted, samples.size())};
  }
  InverseDepth best = first;
  double within = kFit.on_plane;
  double deviation = 0;
  for (int i = 0; i < kFit.refinements; ++i) {
    best = refitted(best, samples, within);
    deviation = deviation_of(best, samples);
    within = std::clamp<double>(kFit.deviations * deviation, kFit.least_on_plane, kFit.on_plane);
  }
  const double slope = best.n.norm();
  const Eigen::Vector3d normal = -best.n / slope;
  return Fitted{best,
                deviation,
                {{static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                  static_cast<float>(normal.z())},
                 static_cast<float>(1 / slope),
                 static_cast<float>(deviation / slope),
                 share_on(best, samples)}};
}

/// The median of nine, by 19 comparisons that need no branch (Paeth, "Median finding on a 3 x 3
/// grid", 1990).
float median_of_nine(std::vector<float>& v) {
  const auto order = [&](std::size_t low, std::size_t high) {
    const float least = std::min(v[low], v[high]);
    v[high] = std::max(v[low], v[high]);
    v[low] = least;
  };
  constexpr std::array<std::array<std::size_t, 2>, 19> kExchanges = {{{1, 2},
                                                                      {4, 5},
                                                                      {7, 8},
                                                                      {0, 1},
                                                                      {3, 4},
                                                                      {6, 7},
                                                                      {1, 2},
                                                                      {4, 5},
                                                                      {7, 8},
                                                                      {0, 3},
                                                                      {5, 8},
                                                                      {4, 7},
                                                                      {3, 6},
                                                                      {1, 4},
                                                                      {2, 5},
                                                                      {4, 7},
                                                                      {4, 2},
                                                                      {6, 4},
                                                                      {4, 2}}};
  for (const auto& [low, high] : kExchanges) order(low, high);
  return v[4];
}

/// [height, width] metres above the plane, the median of a pixel and its measured neighbours; not a
/// number where nothing was measured.
std::vector<float> heights_of(const Frame& frame, const Fitted& table, const Size& size) {
  std::vector<float> raw(size.pixels(), std::nanf(""));
  for (std::size_t pixel = 0; pixel < raw.size(); ++pixel) {
    const float z_m = frame.depth_m[pixel];
    if (!geometry::measured(z_m)) continue;
    raw[pixel] = table.plane.distance_m * static_cast<float>(table.inverse.rho(
                                              ray_at(pixel, frame), static_cast<double>(z_m)));
  }
  std::vector<float> heights = raw;
  std::vector<float> around;
  for (std::size_t pixel = 0; pixel < raw.size(); ++pixel) {
    if (std::isnan(raw[pixel])) continue;
    around.assign(1, raw[pixel]);
    for_each_neighbour(pixel, size, /*diagonals=*/true, [&](std::size_t other) {
      if (!std::isnan(raw[other])) around.push_back(raw[other]);
    });
    heights[pixel] = around.size() == 9 ? median_of_nine(around) : geometry::median_of(around);
  }
  return heights;
}

void check_depth(const Frame& frame, Checks& checks) {
  checks.size(frame.width, frame.height);
  checks.depth(frame);
  checks.intrinsics(frame.intrinsics);
}

Result<Plane> plane_of(const Frame& frame) {
  Checks checks("fit_plane");
  check_depth(frame, checks);
  if (auto fine = checks.outcome(); !fine) return fine.error();
  const auto table = fitted(frame, "fit_plane");
  if (!table) return table.error();
  return table->plane;
}

Result<Mask> by_plane(const Frame& frame, const HeightBand& band) {
  Checks checks("mask_from_plane");
  check_depth(frame, checks);
  checks.positive("HeightBand.least_m", band.least_m, kMostHeight_m);
  checks.positive("HeightBand.most_m", band.most_m, kMostHeight_m);
  if (band.most_m <= band.least_m) {
    checks.fault(fmt::format("HeightBand.most_m: expected more than least_m, {} m, got {} m",
                             band.least_m, band.most_m));
  }
  checks.cleaning(band.cleaning);
  if (auto fine = checks.outcome(); !fine) return fine.error();
  const auto table = fitted(frame, "mask_from_plane");
  if (!table) return table.error();
  const Size size{frame.width, frame.height};
  const auto heights = heights_of(frame, *table, size);
  const float strong = std::max(band.least_m, kDeviationsOfNoise * table->plane.noise_m);
  std::vector<Fit> fits(heights.size(), Fit::kNot);
  for (std::size_t pixel = 0; pixel < heights.size(); ++pixel) {
    const float height = heights[pixel];  // what is not a number fits nothing
    if (!(height >= kWeakShare * strong && height <= band.most_m)) continue;
    fits[pixel] = height >= strong ? Fit::kStrong : Fit::kWeak;
  }
  return cleaned(connected_to_strong(fits, size), size, band.cleaning);
}

}  // namespace
}  // namespace mask

Result<Plane> fit_plane(const Frame& frame) {
  return guard::guarded("fit_plane", [&] { return mask::plane_of(frame); });
}

Result<Mask> mask_from_plane(const Frame& frame, const HeightBand& band) {
  return guard::guarded("mask_from_plane", [&] { return mask::by_plane(frame, band); });
}

}  // namespace flowdlo
