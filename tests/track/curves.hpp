// Curves that tests of tracking tell ropes by.
#pragma once

#include <algorithm>
#include <cmath>

#include "flowdlo/estimate.hpp"

namespace flowdlo::testing {

/// From (x, y) along x, one metre away.
inline Centerline straight(float x, float y, float length = 0.5F) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {x + length * static_cast<float>(i) / (kNodes - 1), y, 1};
  }
  return nodes;
}

/// Round the origin, one metre away; node 0 lies at `turns` of a turn, and so does the last node.
inline Centerline ring(double turns, double radius = 0.2) {
  constexpr double kTurn = 6.283185307179586;
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double angle = kTurn * (turns + static_cast<double>(i) / (kNodes - 1));
    nodes[i] = {static_cast<float>(radius * std::cos(angle)),
                static_cast<float>(radius * std::sin(angle)), 1};
  }
  return nodes;
}

inline Centerline backwards(Centerline nodes) {
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

/// Its support and sigma_m tell where each node was.
inline Estimate rope(const Centerline& nodes, bool closed = false) {
  Estimate estimate;
  estimate.nodes = nodes;
  estimate.closed = closed;
  for (std::size_t i = 0; i < kNodes; ++i) {
    estimate.support[i] = static_cast<std::uint8_t>(i);
    estimate.sigma_m[i] = static_cast<float>(i);
  }
  return estimate;
}

}  // namespace flowdlo::testing
