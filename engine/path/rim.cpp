#include "path/rim.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/quantile.hpp"
#include "path/midline.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kNarrow = 0.88F;  // of the usual width: something is missing
constexpr float kStepPx = 0.5F;
constexpr float kMostReach = 1.2F;       // widths
constexpr float kShortestWidths = 0.5F;  // of rim that gives a direction
constexpr float kTangentWidths = 0.4F;   // of rim, to both sides
constexpr std::size_t kLeastUsual = 5;   // full sections that tell the strand's own width

struct Section {
  Vector2f normal{0, 0};
  float width_px = 0;
  float reach_px[2] = {0, 0};  // along the normal, and against it
  int rim = -1;                // the side that shows where the other is hidden; -1: none
};

float reach_of(const Cover& cover, const Vector2f& from, const Vector2f& direction, float most) {
  float reach = 0;
  while (reach < most && cover.masked(from + (reach + kStepPx) * direction)) reach += kStepPx;
  return reach;
}

std::vector<Section> sections_of(const Points& points, const Cover& cover, float width_px) {
  const int count = static_cast<int>(points.size());
  std::vector<Section> sections(points.size());
  for (int i = 0; i < count; ++i) {
    Section& section = sections[i];
    const Vector2f along = points[std::min(i + 3, count - 1)] - points[std::max(i - 3, 0)];
    if (along.norm() <= 0 || !cover.masked(points[i])) continue;
    section.normal = Vector2f(-along.y(), along.x()).normalized();
    for (const int side : {0, 1}) {
      const Vector2f direction = side == 0 ? section.normal : Vector2f(-section.normal);
      section.reach_px[side] = reach_of(cover, points[i], direction, kMostReach * width_px);
    }
    section.width_px = section.reach_px[0] + section.reach_px[1] + kStepPx;
  }
  return sections;
}

// The width of the strand where it shows whole.
float full_width(const std::vector<Section>& sections, float width_px) {
  std::vector<float> widths;
  for (const Section& section : sections) {
    if (std::abs(section.width_px - width_px) < (1 - kNarrow) * 1.5F * width_px) {
      widths.push_back(section.width_px);
    }
  }
  if (widths.size() < kLeastUsual) return width_px;
  return geometry::median_of(widths);
}

void find_rims(const Points& points, const Cover& cover, float width_px,
               std::vector<Section>& sections) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    Section& section = sections[i];
    if (section.width_px <= 0 || section.width_px > kNarrow * width_px) continue;
    const float rope_m = cover.rope_depth(points[i]);
    const auto hidden = [&](float sign) {
      return cover.beyond(points[i], sign * section.normal, rope_m, width_px) == Sight::kHidden;
    };
    const bool first = hidden(1);
    const bool second = hidden(-1);
    if (first != second) section.rim = first ? 1 : 0;
  }
}

// Points [first, last) all have their rim on one side.
void move_stretch(int first, int last, const std::vector<Section>& sections, float width_px,
                  Points& points) {
  Points rim;
  for (int i = first; i < last; ++i) {
    const Section& section = sections[i];
    const float sign = section.rim == 0 ? 1.0F : -1.0F;
    rim.push_back(points[i] +
                  sign * (section.reach_px[section.rim] + 0.5F * kStepPx) * section.normal);
  }
  const int count = last - first;
  rim = smoothed(std::move(rim), std::max(1, static_cast<int>(0.25F * width_px)));
  const int reach = std::max(2, static_cast<int>(kTangentWidths * width_px));
  for (int k = 0; k < count; ++k) {
    const Vector2f along = rim[std::min(k + reach, count - 1)] - rim[std::max(k - reach, 0)];
    if (along.norm() <= 0) continue;
    const float sign = sections[first + k].rim == 0 ? -1.0F : 1.0F;
    const Vector2f inwards = sign * Vector2f(-along.y(), along.x()).normalized();
    points[first + k] = rim[k] + 0.5F * width_px * inwards;
  }
}

}  // namespace

std::vector<std::uint8_t> centre_on_rim(Points& points, const Cover& cover, float width_px) {
  std::vector<std::uint8_t> moved(points.size(), 0);
  if (points.size() < 5) return moved;
  std::vector<Section> sections = sections_of(points, cover, width_px);
  const float full = full_width(sections, width_px);
  find_rims(points, cover, full, sections);
  const int count = static_cast<int>(points.size());
  for (int first = 0; first < count;) {
    int last = first + 1;
    while (last < count && sections[last].rim == sections[first].rim) ++last;
    const bool long_enough = static_cast<float>(last - first) > kShortestWidths * width_px;
    if (sections[first].rim >= 0 && long_enough) {
      move_stretch(first, last, sections, full, points);
      std::fill(moved.begin() + first, moved.begin() + last, std::uint8_t{1});
    }
    first = last;
  }
  return moved;
}

}  // namespace flowdlo::path
