#include "field/surface.hpp"

#include <cmath>

namespace flowdlo::field {

using Eigen::Vector2f;

Surface::Spot Surface::spot(const Vector2f& p) const {
  static constexpr std::array<float, kChannels> kNothing{};
  const auto left = static_cast<int>(std::floor(p.x()));
  const auto top = static_cast<int>(std::floor(p.y()));
  Spot spot;
  spot.s_ = p.x() - static_cast<float>(left);
  spot.t_ = p.y() - static_cast<float>(top);
  for (int i = 0; i < 4; ++i) {
    const auto* const found = field_.find(top + i / 2, left + i % 2);
    spot.corners_[static_cast<std::size_t>(i)] = found != nullptr ? found : &kNothing;
  }
  return spot;
}

std::optional<Vector2f> Surface::direction(const Spot& spot, const Vector2f& heading) {
  const float cosine = spot.at(kCos);
  const float sine = spot.at(kSin);
  if (std::hypot(cosine, sine) < 1e-3F) return std::nullopt;
  const float angle = 0.5F * std::atan2(sine, cosine);
  const Vector2f along(std::cos(angle), std::sin(angle));
  return along.dot(heading) < 0 ? Vector2f(-along) : along;
}

}  // namespace flowdlo::field
