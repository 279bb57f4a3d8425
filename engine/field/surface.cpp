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
  spot.corners_ = field_.square(top, left);
  for (const auto*& corner : spot.corners_) {
    if (corner == nullptr) corner = &kNothing;
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
