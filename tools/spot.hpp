// Spot: a place on a picture, in pixels.
#pragma once

namespace flowdlo::tools {

/// The centre of the top left pixel is (0, 0).
struct Spot {
  float x = 0;
  float y = 0;

  friend Spot operator+(const Spot& a, const Spot& b) { return {a.x + b.x, a.y + b.y}; }
  friend Spot operator-(const Spot& a, const Spot& b) { return {a.x - b.x, a.y - b.y}; }
  friend Spot operator*(float times, const Spot& spot) { return {times * spot.x, times * spot.y}; }
};

}  // namespace flowdlo::tools
