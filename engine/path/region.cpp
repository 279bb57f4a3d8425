#include "path/region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/mask_box.hpp"
#include "geometry/pixel.hpp"
#include "image/components.hpp"
#include "image/distance.hpp"
#include "image/masks.hpp"
#include "path/fringe.hpp"
#include "path/strokes.hpp"

namespace flowdlo::path {
namespace {

constexpr int kBorderPx = 2;
constexpr int kSpeckAreaPx = 12;            // below this no direction can be told
constexpr float kSpeckWidths = 0.6F;        // components below this times width^2 are noise
constexpr float kHoleSpecksWidths = 0.05F;  // holes below this times width^2 are noise
constexpr float kHighlightWidths = 0.68F;   // filled half-width up to which a hole is a highlight
constexpr float kHighlightArea = 6.0F;      // and its area in width^2, at most

image::Mask crop(const Frame& frame, const image::Rect& box) {
  image::Mask mask(image::grown(box, kBorderPx).size(), 0);
  for (int v = 0; v < box.height; ++v) {
    const std::uint8_t* from =
        frame.mask.data() + static_cast<std::size_t>(box.y + v) * frame.width + box.x;
    std::uint8_t* to = mask.row(v + kBorderPx) + kBorderPx;
    for (int u = 0; u < box.width; ++u) to[u] = from[u] > 127 ? 1 : 0;
  }
  return mask;
}

// Median width over ridges of the distance, each weighted by its distance (frayed borders have
// many ridges, but low ones), and only those not much higher than the low ones: where strands lie
// beside each other the mask is twice as wide.
float ridge_width(const image::Image<float>& distance) {
  std::vector<double> weight(512, 0.0);
  image::for_ridges(distance, [&](float d) {
    const auto bin = static_cast<std::size_t>(std::lround(d * 2));
    if (bin >= weight.size()) weight.resize(bin + 1, 0.0);
    weight[bin] += d;
  });
  const auto quantile = [&](double share, std::size_t bins) {
    double all = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) all += weight[bin];
    double sum = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
      sum += weight[bin];
      if (sum >= share * all) return bin;
    }
    return bins;
  };
  const std::size_t narrow = quantile(0.2, weight.size());
  const std::size_t usual = quantile(0.5, std::min(weight.size(), narrow * 3 / 2 + 1));
  return std::max(1.0F, width_at(static_cast<float>(usual) * 0.5F));
}

// Erases the components below `least_area`; returns the largest one's area, 0 if none is left.
int erase_specks(image::Mask& mask, double least_area) {
  const auto [labels, pieces] = image::components(mask, image::Neighbours::kEight);
  const std::size_t count = pieces.size();
  int largest = 0;
  for (std::size_t i = 1; i < count; ++i) largest = std::max(largest, pieces[i].area);
  std::vector<std::uint8_t> keep(count, 0);
  bool all = true;
  for (std::size_t i = 1; i < count; ++i) {
    const int area = pieces[i].area;
    keep[i] = area >= kSpeckAreaPx && (area >= least_area || area == largest) ? 1 : 0;
    all = all && keep[i] != 0;
  }
  if (all) return largest;
  image::set_pieces(labels, keep, mask);
  return largest >= kSpeckAreaPx ? largest : 0;
}

// A highlight lies inside one strand: with it filled, the strand is no wider than the rope. A
// hole between two strands makes the filled mask wider than that and is kept.
bool fill_highlights(image::Mask& mask, float width) {
  const auto [labels, pieces] = image::components(image::inverse(mask), image::Neighbours::kFour);
  const std::size_t count = pieces.size();
  if (count <= 2) return false;
  const auto outside = static_cast<std::size_t>(labels.at(0, 0));
  const double speck = std::max(3.0, static_cast<double>(kHoleSpecksWidths * width * width));
  const double most = kHighlightArea * width * width;
  std::vector<std::uint8_t> fill(count, 0);
  for (std::size_t i = 1; i < count; ++i) {
    if (i != outside && pieces[i].area <= most) fill[i] = 1;
  }
  if (std::find(fill.begin(), fill.end(), 1) == fill.end()) return false;
  fill.front() = 1;  // what is mask already
  image::Mask filled(mask.size());
  image::set_pieces(labels, fill, filled);
  const image::Image<float> distance = image::distance_to_empty(filled);
  std::vector<float> depth(count, 0.0F);
  for (int v = 0; v < mask.height(); ++v) {
    const int* label = labels.row(v);
    const float* row = distance.row(v);
    for (int u = 0; u < mask.width(); ++u) {
      if (fill[label[u]] != 0) depth[label[u]] = std::max(depth[label[u]], row[u]);
    }
  }
  bool any = false;
  for (std::size_t i = 1; i < count; ++i) {
    if (fill[i] == 0) continue;
    const bool tiny = pieces[i].area <= speck;
    fill[i] = tiny || depth[i] <= kHighlightWidths * width ? 1 : 0;
    any = any || fill[i] != 0;
  }
  if (!any) return false;
  image::set_pieces(labels, fill, mask);
  return true;
}

}  // namespace

bool lit(const image::Mask& mask, int u, int v) {
  return u >= 0 && v >= 0 && u < mask.width() && v < mask.height() && mask.at(v, u) != 0;
}

bool lit(const image::Mask& mask, const Eigen::Vector2f& p) {
  return lit(mask, geometry::nearest_px(p.x()), geometry::nearest_px(p.y()));
}

Region smoothed(const Region& region, int size_px) {
  Region result = region;
  result.mask = image::majority(region.mask, size_px);
  if (erase_specks(result.mask, kSpeckWidths * region.width_px * region.width_px) == 0) {
    return region;
  }
  fill_highlights(result.mask, region.width_px);
  result.distance_px = image::distance_to_empty(result.mask);
  return result;
}

Result<Region> clean(const Frame& frame, int ropes) {
  const image::Rect box = geometry::mask_box(frame);
  if (box.empty()) {
    return Error{
        ErrorCode::kNoPath,
        "path: expected a rope in the mask, got no pixel above 127; check the segmentation"};
  }
  Region region;
  region.offset_px = {box.x - kBorderPx, box.y - kBorderPx};
  auto strokes = strokes_of(crop(frame, box), {frame.width, frame.height}, ropes);
  if (!strokes) return strokes.error();
  region.mask = std::move(strokes->mask);
  region.filtered = strokes->filtered;
  erase_fringes(region.mask);
  if (erase_specks(region.mask, 0) == 0) {
    return Error{ErrorCode::kNoPath,
                 fmt::format("path: expected a stroke, got only specks of fewer than {} pixels; "
                             "check the segmentation",
                             kSpeckAreaPx)};
  }
  region.distance_px = image::distance_to_empty(region.mask);
  region.width_px = ridge_width(region.distance_px);
  const image::Mask measured = region.mask.clone();
  erase_specks(region.mask, kSpeckWidths * region.width_px * region.width_px);
  fill_highlights(region.mask, region.width_px);
  if (image::same(region.mask, measured)) return region;
  region.distance_px = image::distance_to_empty(region.mask);
  region.width_px = ridge_width(region.distance_px);
  return region;
}

}  // namespace flowdlo::path
