#include "prior/depth_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

constexpr int kCauchyRounds = 3;
constexpr int kTukeyRounds = 2;
constexpr double kCauchySigmas = 2.0;
constexpr double kTukeySigmas = 4.685;  // 95 % efficient for Gaussian noise
constexpr std::size_t kScaleSample = 1500;
constexpr std::size_t kScatter = 2654435761U;  // 2^32 over the golden ratio

/// The symmetric matrix of second and first differences plus a diagonal: bands 0, 1 and 2.
class Pentadiagonal {
 public:
  Pentadiagonal(const std::vector<double>& slant, double whole_stiffness, double whole_tension)
      : bands_(slant.size()), factor_(slant.size()) {
    const std::size_t size = slant.size();
    for (std::size_t i = 0; i + 2 < size; ++i) {  // (1, -2, 1)
      const double stiffness = whole_stiffness / slant[i + 1];
      bands_[i][0] += stiffness;
      bands_[i + 1][0] += 4 * stiffness;
      bands_[i + 2][0] += stiffness;
      bands_[i][1] -= 2 * stiffness;
      bands_[i + 1][1] -= 2 * stiffness;
      bands_[i][2] += stiffness;
    }
    for (std::size_t i = 0; i + 1 < size; ++i) {  // (-1, 1)
      const double tension = whole_tension / slant[i];
      bands_[i][0] += tension;
      bands_[i + 1][0] += tension;
      bands_[i][1] -= tension;
    }
  }

  /// Solves (this + diagonal) x = right in place, by L D L^T.
  void solve(const std::vector<double>& diagonal, std::vector<double>& right) {
    const std::size_t n = bands_.size();
    for (std::size_t i = 0; i < n; ++i) {
      double d = bands_[i][0] + diagonal[i];
      double off = i > 0 ? bands_[i - 1][1] : 0;
      if (i > 1) {
        const auto& f = factor_[i - 2];
        d -= f[2] * f[2] * f[0];
        off -= f[1] * f[2] * f[0];
        right[i] -= f[2] * right[i - 2];
      }
      if (i > 0) {
        auto& f = factor_[i - 1];
        f[1] = off / f[0];
        d -= f[1] * f[1] * f[0];
        right[i] -= f[1] * right[i - 1];
      }
      factor_[i] = {d, 0, bands_[i][2] / d};
    }
    for (std::size_t i = n; i-- > 0;) {
      right[i] /= factor_[i][0];
      if (i + 1 < n) right[i] -= factor_[i][1] * right[i + 1];
      if (i + 2 < n) right[i] -= factor_[i][2] * right[i + 2];
    }
  }

 private:
  std::vector<std::array<double, 3>> bands_;
  std::vector<std::array<double, 3>> factor_;  // D, and the two bands of L below it
};

/// Medians over blocks, joined by straight lines.
std::vector<double> first_guess(int stations, std::span<const DepthClaim> claims, float block) {
  const int length = std::max(1, static_cast<int>(block));
  std::vector<std::vector<double>> seen(static_cast<std::size_t>(stations / length) + 1);
  for (const DepthClaim& claim : claims) {
    if (claim.weight > 0) {
      seen[static_cast<std::size_t>(claim.station / length)].push_back(
          static_cast<double>(claim.depth_m));
    }
  }
  std::vector<double> guess(static_cast<std::size_t>(stations), 0.0);
  double from = -1;
  double z_from = 0;
  for (std::size_t b = 0; b < seen.size(); ++b) {
    if (seen[b].empty()) continue;
    const double to = (static_cast<double>(b) + 0.5) * length;
    const double z = geometry::median_of(seen[b]);
    for (int i = std::max(0, static_cast<int>(std::ceil(from))); i < stations; ++i) {
      const double t = from < 0 ? 1 : std::min(1.0, (i - from) / (to - from));
      guess[static_cast<std::size_t>(i)] = from < 0 ? z : z_from + t * (z - z_from);
    }
    from = to;
    z_from = z;
  }
  return guess;
}

/// From a sample scattered over the claims: a regular one would see the same place of every
/// cross-section.
double robust_sigma(std::span<const DepthClaim> claims, const std::vector<double>& profile,
                    const std::vector<double>& slant) {
  std::vector<double> misfits;
  const std::size_t count = std::min(claims.size(), kScaleSample);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t pick = count < claims.size() ? k * kScatter % claims.size() : k;
    const DepthClaim& claim = claims[pick];
    if (claim.weight <= 0) continue;
    const auto i = static_cast<std::size_t>(claim.station);
    misfits.push_back(std::abs(static_cast<double>(claim.depth_m) - profile[i]) / slant[i]);
  }
  return misfits.empty() ? 0 : 1.4826 * geometry::median_of(misfits);
}

double robust_weight(double misfit, double scale, bool tukey) {
  const double u = misfit / scale;
  if (!tukey) return 1 / (1 + u * u);
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

}  // namespace

std::vector<double> fit_profile(int stations, std::span<const DepthClaim> claims,
                                std::span<const double> guess_m, const ProfileConfig& config) {
  const auto n = static_cast<std::size_t>(stations);
  const double smoothing = std::max(1.0F, config.smoothing_stations);
  const double tension = std::max(smoothing, static_cast<double>(config.tension_stations));
  const double stiffness = std::pow(smoothing, 4);
  std::vector<double> slant(config.slant.begin(), config.slant.end());
  slant.resize(n, 1.0);
  Pentadiagonal system(slant, stiffness, stiffness / (tension * tension));
  std::vector<double> profile(guess_m.begin(), guess_m.end());
  if (profile.empty()) profile = first_guess(stations, claims, config.smoothing_stations);
  const double share = 1 / std::max(1.0, static_cast<double>(config.claims_per_station));
  const double forgiven = static_cast<double>(config.noise_m);
  std::vector<double> weights(n);
  std::vector<double> right(n);
  for (int round = 0; round < kCauchyRounds + kTukeyRounds; ++round) {
    const bool tukey = round >= kCauchyRounds;
    const double sigma = std::max(robust_sigma(claims, profile, slant), 0.5 * forgiven);
    const double scale = (tukey ? kTukeySigmas : kCauchySigmas) * sigma;
    std::fill(weights.begin(), weights.end(), 0.0);
    std::fill(right.begin(), right.end(), 0.0);
    for (const DepthClaim& claim : claims) {
      const auto i = static_cast<std::size_t>(claim.station);
      const double depth = static_cast<double>(claim.depth_m);
      const double weight = share * static_cast<double>(claim.weight) *
                            robust_weight((depth - profile[i]) / slant[i], scale, tukey);
      weights[i] += weight;
      right[i] += weight * depth;
    }
    double total = 0;
    for (const double weight : weights) total += weight;
    if (!(total > 1e-9)) break;  // nothing fits: the last profile stands
    system.solve(weights, right);
    std::swap(profile, right);
  }
  return profile;
}

}  // namespace flowdlo::prior
