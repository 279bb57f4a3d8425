#include "field/surface.hpp"

#include <cmath>

namespace flowdlo::field {

using Eigen::Vector2f;

float Surface::at(const Vector2f& p, Channel channel) const {
  const auto left = static_cast<int>(std::floor(p.x()));
  const auto top = static_cast<int>(std::floor(p.y()));
  const float s = p.x() - static_cast<float>(left);
  const float t = p.y() - static_cast<float>(top);
  return (1 - t) * ((1 - s) * pixel(left, top, channel) + s * pixel(left + 1, top, channel)) +
         t * ((1 - s) * pixel(left, top + 1, channel) + s * pixel(left + 1, top + 1, channel));
}

std::optional<Vector2f> Surface::direction(const Vector2f& p, const Vector2f& heading) const {
  const float cosine = at(p, kCos);
  const float sine = at(p, kSin);
  if (std::hypot(cosine, sine) < 1e-3F) return std::nullopt;
  const float angle = 0.5F * std::atan2(sine, cosine);
  const Vector2f along(std::cos(angle), std::sin(angle));
  return along.dot(heading) < 0 ? Vector2f(-along) : along;
}

}  // namespace flowdlo::field
