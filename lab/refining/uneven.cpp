#include "refining/uneven.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "geometry/camera.hpp"
#include "geometry/depth.hpp"

namespace flowdlo::refining {
namespace {

constexpr std::size_t kWaves = 12;
constexpr double kLeastHeight_m = 0.001;
constexpr double kMostHeight_m = 0.008;
constexpr double kShortest_m = 0.03;
constexpr double kLongest_m = 0.3;

/// A sum of waves over the image, with a deviation of `height_m`.
class Waves {
 public:
  Waves(std::uint64_t seed, double pixels_a_metre) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(0, 1);
    const auto log_uniform = [&](double low, double high) {
      return low * std::pow(high / low, any(random));
    };
    height_m_ = log_uniform(kLeastHeight_m, kMostHeight_m) * std::sqrt(2.0 / kWaves);
    for (Wave& wave : waves_) {
      const double length_px = log_uniform(kShortest_m, kLongest_m) * pixels_a_metre;
      const double way = std::numbers::pi * any(random);
      wave = {2 * std::numbers::pi / length_px * std::cos(way),
              2 * std::numbers::pi / length_px * std::sin(way), 2 * std::numbers::pi * any(random)};
    }
  }

  [[nodiscard]] float at(double u, double v) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.u * u + wave.v * v + wave.phase);
    return static_cast<float>(height_m_ * sum);
  }

 private:
  struct Wave {
    double u = 0;  // radians a pixel
    double v = 0;
    double phase = 0;
  };
  std::array<Wave, kWaves> waves_{};
  double height_m_ = 0;
};

}  // namespace

void make_uneven(std::uint64_t seed, synth::SyntheticFrame& scene) {
  const Intrinsics& camera = scene.folder.intrinsics;
  const Waves waves(seed, static_cast<double>(camera.fx) / scene.meta.distance_m);
  const auto width = static_cast<std::size_t>(scene.folder.width);
  for (std::size_t i = 0; i < scene.folder.depth_m.size(); ++i) {
    float& depth_m = scene.folder.depth_m[i];
    if (!geometry::measured(depth_m)) continue;
    depth_m += waves.at(static_cast<double>(i % width), static_cast<double>(i / width));
  }
  for (Point3& node : *scene.folder.truth) {
    const Eigen::Vector2f px = geometry::project(camera, node);
    const float share =
        1 + waves.at(static_cast<double>(px.x()), static_cast<double>(px.y())) / node.z;
    node = {share * node.x, share * node.y, share * node.z};
  }
}

}  // namespace flowdlo::refining
