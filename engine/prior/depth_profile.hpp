// DepthProfile: one smooth depth along the rope through noisy, missing and foreign depths.
#pragma once

#include <span>
#include <vector>

namespace flowdlo::prior {

/// A depth that somebody claims for a station.
struct DepthClaim {
  int station = 0;
  float depth_m = 0;
  float weight = 1;
};

struct ProfileConfig {
  float smoothing_stations = 8;  ///< bends in depth shorter than this are noise
  float tension_stations = 48;   ///< gaps longer than this are bridged by straight lines
  float claims_per_station = 8;  ///< what a well-seen station has
  float noise_m = 0.002F;        ///< misfit that is always forgiven
  /// [stations] >= 1, or empty: 1 / sin of the angle between ray and rope. Where the rope runs
  /// towards the camera a pixel is that much more rope: the same bend is more depth, and so is the
  /// same error of the mask.
  std::span<const float> slant{};
};

/// [stations] depth minimising
///   sum w slant_i^2 rho((z_i - claim) / slant_i)
///     + stiffness sum (z_{i-1} - 2 z_i + z_{i+1})^2 / slant_i
///     + tension   sum (z_{i+1} - z_i)^2 / slant_i,
/// rho Cauchy's, then Tukey's biweight: claims far from what most say count nothing. Beyond the
/// outermost claims the profile goes on along its slope, which dies away over `tension_stations`.
/// Starts from `guess_m` when it is not empty. Needs a claim of positive weight.
[[nodiscard]] std::vector<double> fit_profile(int stations, std::span<const DepthClaim> claims,
                                              std::span<const double> guess_m,
                                              const ProfileConfig& config);

}  // namespace flowdlo::prior
