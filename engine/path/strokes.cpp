#include "path/strokes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "image/masks.hpp"
#include "path/limits.hpp"

namespace flowdlo::path {
namespace {

constexpr int kFilters_px[] = {5, 13, 21};  // sides of the majority filters, the mildest first

image::Mask majority(const image::Mask& mask, int side_px) {
  image::Mask result = image::majority(mask, side_px);
  const int right = result.width() - 1;
  const int bottom = result.height() - 1;
  for (const int v : {0, bottom}) std::fill_n(result.row(v), result.width(), std::uint8_t{0});
  for (int v = 0; v <= bottom; ++v) result.at(v, 0) = result.at(v, right) = 0;
  return result;
}

}  // namespace

std::int64_t stroke_length_px(const image::Mask& mask) {
  std::int64_t border = 0;
  for (int v = 1; v + 1 < mask.height(); ++v) {
    const std::uint8_t* up = mask.row(v - 1);
    const std::uint8_t* row = mask.row(v);
    const std::uint8_t* down = mask.row(v + 1);
    int here = 0;
    for (int u = 1; u + 1 < mask.width(); ++u) {
      here += row[u] & ((row[u - 1] & row[u + 1] & up[u] & down[u]) ^ 1);
    }
    border += here;
  }
  return border / 2;
}

Result<Strokes> strokes_of(image::Mask mask, const image::Size& image, int ropes) {
  const std::int64_t sides = image.width + image.height;
  const std::int64_t one = kMostStrokeSides * sides;
  const std::int64_t most = ropes == 1 ? one : kMostRopesSides * sides;
  const std::int64_t given = stroke_length_px(mask);
  if (given <= most) return Strokes{std::move(mask)};
  for (const int side_px : kFilters_px) {
    image::Mask smooth = majority(mask, side_px);
    if (stroke_length_px(smooth) <= one) return Strokes{std::move(smooth), true};
  }
  return Error{
      ErrorCode::kNoPath,
      fmt::format("path: expected {}, strokes at most {} px long in an image of {} x "
                  "{}, got {} px of noise or texture; check the segmentation",
                  ropes == 1 ? "one rope" : "ropes", most, image.width, image.height, given)};
}

}  // namespace flowdlo::path
