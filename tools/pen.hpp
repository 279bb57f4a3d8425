// Pen: lines, discs and words with smooth edges on an image, by Anti-Grain Geometry.
#pragma once

#include <span>
#include <string>
#include <utility>

#include "image/image.hpp"
#include "spot.hpp"

namespace flowdlo::tools {

/// How words look: as high as a capital letter, in lines of that width.
struct Lettering {
  float height_px = 0;
  float line_px = 0;

  /// From the left side of the first letter to the right one of the last.
  [[nodiscard]] float width_px(const std::string& words) const;
};

/// A pixel of which the ink covers a part takes that part of its colour; what lies beyond the image
/// is not drawn. Pixel: support::Color, or std::uint8_t of a mask.
template <class Pixel>
class Pen {
 public:
  /// Draws on the pixels of `paper`, which it shares.
  explicit Pen(image::Image<Pixel> paper) : paper_(std::move(paper)) {}

  /// From each point to the next; joints and ends are round. Points in one place are a disc.
  void stroke(std::span<const Spot> points, float width_px, const Pixel& ink);
  void disc(const Spot& center, float radius_px, const Pixel& ink);
  /// A circle, on both sides of which half the line's width lies.
  void ring(const Spot& center, float radius_px, float line_px, const Pixel& ink);
  /// On a line that begins at `start`. What is no printable letter of ASCII becomes a "?".
  void write(const std::string& words, const Spot& start, const Lettering& lettering,
             const Pixel& ink);

 private:
  image::Image<Pixel> paper_;
};

}  // namespace flowdlo::tools
