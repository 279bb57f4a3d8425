#include "prior/ground.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

constexpr float kWindowWidths = 4.0F;  // to both sides along the rope, over which the median goes
constexpr float kLeastWindowPx = 20.0F;
constexpr std::size_t kLeastKnown = 7;  // stations of a window
constexpr double kForgiven = 0.15;      // radii; less is nothing,
constexpr double kTold = 0.3;           // and this counts whole
constexpr double kMost = 2.5;           // radii; a rope on the ground that shows nothing is 2 off

/// From the axis to the plane of the ground along the ray, z, of a rope of radius 1 that lies on
/// it; 0 where the ground is unknown around `i`.
double height(const Strip& strip, int i, int reach) {
  const auto at = [&](int k) -> const Station& {
    return strip.stations[static_cast<std::size_t>(k)];
  };
  int a = std::max(0, i - reach);
  int b = std::min(static_cast<int>(strip.stations.size()) - 1, i + reach);
  while (a < i && at(a).ground_m <= 0) ++a;
  while (b > i && at(b).ground_m <= 0) --b;
  const Eigen::Vector3f along = at(b).ray * at(b).ground_m - at(a).ray * at(a).ground_m;
  const Eigen::Vector3f normal = at(i).ground_across.cross(along);
  const float toward = std::abs(normal.dot(at(i).ray));
  return toward > 0 ? static_cast<double>(normal.norm() / toward) : 0;
}

}  // namespace

std::vector<double> too_deep_m(const Strip& strip, std::span<const double> axis_m, float radius_m) {
  const int count = static_cast<int>(strip.stations.size());
  const int reach =
      std::max(3, static_cast<int>(std::max(kWindowWidths * strip.width_px, kLeastWindowPx) /
                                   std::max(strip.step_px, 1e-3F)));
  const auto radius = static_cast<double>(radius_m);
  std::vector<double> known;  // of stations whose ground is known,
  std::vector<int> stations;  // which these are
  for (int i = 0; i < count; ++i) {
    const Station& at = strip.stations[static_cast<std::size_t>(i)];
    if (at.ground_m <= 0) continue;
    const double rise = radius * height(strip, i, reach);
    const double deep =
        axis_m[static_cast<std::size_t>(i)] + rise - static_cast<double>(at.ground_m);
    if (rise <= 0 || deep > kMost * rise) continue;
    stations.push_back(i);
    known.push_back(deep / rise * radius);
  }
  std::vector<double> result(strip.stations.size(), 0.0);
  const int step = std::max(1, reach / 4);  // medians are taken here, and joined by lines
  std::vector<double> window;
  std::size_t first = 0;
  double before = 0;
  for (int i = 0; i < count + step - 1; i += step) {
    const int middle = std::min(i, count - 1);
    while (first < stations.size() && stations[first] < middle - reach) ++first;
    window.clear();
    for (std::size_t k = first; k < stations.size() && stations[k] <= middle + reach; ++k) {
      window.push_back(known[k]);
    }
    double here = 0;
    if (window.size() >= kLeastKnown) {
      const double median = geometry::median_of(window);
      here = median * std::clamp((median / radius - kForgiven) / (kTold - kForgiven), 0.0, 1.0);
    }
    const int from = std::max(0, i - step);
    for (int k = from; k <= middle; ++k) {
      const double t = middle > from ? static_cast<double>(k - from) / (middle - from) : 1.0;
      result[static_cast<std::size_t>(k)] = (i == 0 ? here : before + t * (here - before));
    }
    before = here;
  }
  return result;
}

}  // namespace flowdlo::prior
