#include "evidence/inverse_plane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/quantile.hpp"
#include "random/philox.hpp"

namespace flowdlo::evidence {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kLeastDepths = 48;
constexpr std::uint64_t kTriples = 80;
constexpr std::size_t kJudges = 192;  // depths that judge a triple's plane
constexpr double kFlattest = 1e-7;    // determinant of three rays
constexpr int kRounds = 5;            // of Tukey's biweight
constexpr double kTukey = 3.5;        // misfits
constexpr double kDeviation = 1.4826;
constexpr double kLeastMisfit = 1e-4;  // 1 / m

/// Of every `stride`-th of `depths`.
double median_misfit(const Vector3d& normal, std::span<const InverseDepth> depths,
                     std::size_t stride) {
  std::vector<double> misfits;
  misfits.reserve(depths.size() / stride + 1);
  for (std::size_t i = 0; i < depths.size(); i += stride) {
    misfits.push_back(std::abs(InversePlane{normal}.off(depths[i])));
  }
  return geometry::median_of(misfits);
}

double deviation(const Vector3d& normal, std::span<const InverseDepth> depths) {
  return std::max(kLeastMisfit, kDeviation * median_misfit(normal, depths, 1));
}

/// Nothing where all triples lie on lines of the image.
std::optional<Vector3d> of_least_median(std::span<const InverseDepth> depths) {
  const std::size_t stride = std::max<std::size_t>(1, depths.size() / kJudges);
  std::optional<Vector3d> best;
  double least = 0;
  for (std::uint64_t triple = 0; triple < kTriples; ++triple) {
    const auto words = random::philox(/*seed=*/0, triple);
    Matrix3d rays;
    Vector3d inverse;
    for (int k = 0; k < 3; ++k) {
      const InverseDepth& one = depths[words[static_cast<std::size_t>(k)] % depths.size()];
      rays.row(k) = one.ray;
      inverse(k) = one.inverse;
    }
    if (std::abs(rays.determinant()) < kFlattest) continue;
    const Vector3d normal = rays.inverse() * inverse;
    const double here = median_misfit(normal, depths, stride);
    if (best && here >= least) continue;
    best = normal;
    least = here;
  }
  return best;
}

Vector3d by_biweight(Vector3d normal, std::span<const InverseDepth> depths) {
  for (int round = 0; round < kRounds; ++round) {
    const double most = kTukey * deviation(normal, depths);
    Matrix3d products = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const InverseDepth& one : depths) {
      const double off = InversePlane{normal}.off(one) / most;
      if (std::abs(off) >= 1) continue;
      const double weight = (1 - off * off) * (1 - off * off);
      products += weight * one.ray * one.ray.transpose();
      right += weight * one.inverse * one.ray;
    }
    products += 1e-9 * products.trace() * Matrix3d::Identity();
    normal = products.ldlt().solve(right);
  }
  return normal;
}

}  // namespace

std::optional<InversePlane> inverse_plane(std::span<const InverseDepth> depths) {
  if (depths.size() < kLeastDepths) return std::nullopt;
  const auto first = of_least_median(depths);
  if (!first) return std::nullopt;
  const Vector3d normal = by_biweight(*first, depths);
  if (!normal.allFinite() || !(normal.norm() > 0)) return std::nullopt;
  return InversePlane{normal, deviation(normal, depths)};
}

}  // namespace flowdlo::evidence
