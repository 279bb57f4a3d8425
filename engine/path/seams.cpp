#include "path/seams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "image/brush.hpp"
#include "image/components.hpp"
#include "image/masks.hpp"
#include "path/thinning.hpp"
#include "path/valleys.hpp"

namespace flowdlo::path {
namespace {

constexpr float kSlitWidths = 0.35F;   // slits of the mask up to this wide belong to a seam
constexpr float kWideShare = 0.56F;    // half a square that fits in two strands and not in one
constexpr float kReachWidths = 0.6F;   // and how far from there a seam may run
constexpr float kExtentWidths = 4.5F;  // what holds a seam extends this far
constexpr float kNoiseLow = 2.0F;      // a seam's least depth in sigmas,
constexpr float kRadiiLow = 0.12F;     // and in radii of the rope;
constexpr float kNoiseHigh = 3.5F;     // half of it is at least this deep
constexpr float kRadiiHigh = 0.3F;
constexpr float kShortestWidths = 6.0F;  // what a flat crossing leaves is shorter
constexpr float kSpurWidths = 0.7F;      // a branch that leads nowhere is shorter
constexpr float kRungWidths = 1.3F;      // and so is a shallow one from seam to seam
constexpr float kTangentWidths = 0.5F;   // what tells a line's direction at its tip
constexpr float kRunOutWidths = 0.6F;    // from there to the mask's edge
constexpr float kSliverWidths = 0.3F;    // cut off between a seam and a slit

// Where `closed` is wider than one strand, for long enough to hold a seam; and what is near to
// that. Empty when nothing is.
image::Mask wide_parts(const image::Mask& closed, const SeamScale& scale) {
  const int strand = static_cast<int>(std::ceil(kWideShare * scale.narrow_px));
  image::Mask wide = image::eroded(closed, strand);
  if (image::count_set(wide) == 0) return {};
  const auto reach = static_cast<int>(std::ceil(kReachWidths * scale.narrow_px));
  wide = image::dilated(image::dilated(wide, strand), reach);
  const auto [labels, pieces] = image::components(wide, image::Neighbours::kEight);
  std::vector<std::uint8_t> keep(pieces.size(), 0);
  bool any = false;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto extent = static_cast<float>(std::max(pieces[i].box.width, pieces[i].box.height));
    keep[i] = extent >= kExtentWidths * scale.width_px ? 1 : 0;
    any = any || keep[i] != 0;
  }
  if (!any) return {};
  for (int v = 0; v < wide.height(); ++v) {
    const int* label = labels.row(v);
    std::uint8_t* row = wide.row(v);
    for (int u = 0; u < wide.width(); ++u) row[u] = keep[label[u]];
  }
  return wide;
}

// The band of pixels that seams run in: of the closed mask's wide parts, what is slit or valley.
// False when there is no valley.
bool keep_valleys(const image::Mask& mask, const image::Mask& wide,
                  const image::Image<float>& valley_m, float low_m, image::Mask& band) {
  bool any = false;
  for (int v = 0; v < mask.height(); ++v) {
    const std::uint8_t* lit = mask.row(v);
    const std::uint8_t* open = wide.row(v);
    const float* depth = valley_m.row(v);
    std::uint8_t* to = band.row(v);
    for (int u = 0; u < mask.width(); ++u) {
      const bool valley = lit[u] != 0 && depth[u] > low_m;
      if (open[u] == 0 || (lit[u] != 0 && !valley)) to[u] = 0;
      any = any || (valley && to[u] != 0);
    }
  }
  return any;
}

int around(const image::Mask& lines, int u, int v) {
  int count = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) count += lines.at(v + dv, u + du) != 0 ? 1 : 0;
  }
  return count - 1;
}

struct Branch {
  int length = 0;
  int tips = 0;
  int inside = 0;     // of the mask, not of a slit
  float depth_m = 0;  // summed over those
};

// The stretches of `lines` between tips and forks, numbered from 1 in `labels`.
std::vector<Branch> branches_of(const image::Mask& lines, const image::Mask& mask,
                                const image::Image<float>& valley_m, image::Image<int>& labels) {
  image::Mask open = lines.clone();
  image::Mask tips(lines.size(), 0);
  for (int v = 1; v + 1 < lines.height(); ++v) {
    for (int u = 1; u + 1 < lines.width(); ++u) {
      if (lines.at(v, u) == 0) continue;
      const int degree = around(lines, u, v);
      if (degree > 2) open.at(v, u) = 0;
      tips.at(v, u) = degree < 2 ? 1 : 0;
    }
  }
  image::Components found = image::components(open, image::Neighbours::kEight);
  labels = std::move(found.labels);
  std::vector<Branch> branches(found.pieces.size());
  for (int v = 1; v + 1 < lines.height(); ++v) {
    for (int u = 1; u + 1 < lines.width(); ++u) {
      const int label = labels.at(v, u);
      if (label == 0) continue;
      Branch& branch = branches[static_cast<std::size_t>(label)];
      ++branch.length;
      branch.tips += tips.at(v, u);
      if (mask.at(v, u) == 0) continue;
      ++branch.inside;
      branch.depth_m += valley_m.at(v, u);
    }
  }
  return branches;
}

// Takes from `lines` branches that lead nowhere and are shorter than `spur_px`, and those shorter
// than `rung_px` that are less deep than `high_m` in the mean.
void prune(image::Mask& lines, const image::Mask& mask, const image::Image<float>& valley_m,
           float high_m, float spur_px, float rung_px) {
  image::Image<int> labels;
  const std::vector<Branch> branches = branches_of(lines, mask, valley_m, labels);
  for (int v = 1; v + 1 < lines.height(); ++v) {
    for (int u = 1; u + 1 < lines.width(); ++u) {
      const int label = labels.at(v, u);
      if (label == 0) continue;
      const Branch& branch = branches[static_cast<std::size_t>(label)];
      const auto length = static_cast<float>(branch.length);
      const bool shallow =
          length < rung_px && branch.depth_m < high_m * static_cast<float>(branch.inside);
      if (shallow || (branch.tips == 1 && length < spur_px)) lines.at(v, u) = 0;
    }
  }
  lines = thin(lines);
}

// The line's pixel some steps from its tip.
image::Point back_from(const image::Mask& lines, image::Point tip, int steps) {
  image::Point before = tip;
  image::Point at = tip;
  for (int i = 0; i < steps; ++i) {
    image::Point next = at;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const image::Point p = at + image::Point{du, dv};
        const image::Point off = p - before;
        const bool away = std::max(std::abs(off.x), std::abs(off.y)) > 1 || before == at;
        if (p != at && p != before && away && lines.at(p) != 0) next = p;
      }
    }
    if (next == at) break;
    before = at;
    at = next;
  }
  return at;
}

image::Point on_the_way(const image::Point& from, const image::Point& along, float share) {
  const auto at = [share](int start, int by) {
    return static_cast<int>(std::lrint(static_cast<float>(start) + share * static_cast<float>(by)));
  };
  return {at(from.x, along.x), at(from.y, along.y)};
}

// Thinning ends a line before the mask does: tips run on to its edge where that is near.
void run_out(image::Mask& lines, const image::Mask& mask, float width_px) {
  std::vector<image::Point> added;
  for (int v = 1; v + 1 < lines.height(); ++v) {
    for (int u = 1; u + 1 < lines.width(); ++u) {
      const image::Point tip{u, v};
      if (lines.at(tip) == 0 || mask.at(tip) == 0) continue;
      if (around(lines, u, v) != 1) continue;
      const int steps = std::max(3, static_cast<int>(kTangentWidths * width_px));
      const image::Point along = tip - back_from(lines, tip, steps);
      const float length = std::hypot(static_cast<float>(along.x), static_cast<float>(along.y));
      const int reach = static_cast<int>(kRunOutWidths * width_px);
      std::vector<image::Point> way;
      for (int k = 1; k <= reach && length > 0; ++k) {
        const image::Point p = on_the_way(tip, along, static_cast<float>(k) / length);
        if (p.x < 1 || p.y < 1 || p.x + 1 >= lines.width() || p.y + 1 >= lines.height()) break;
        if (mask.at(p) == 0) {
          added.insert(added.end(), way.begin(), way.end());
          break;
        }
        way.push_back(p);
      }
    }
  }
  for (const image::Point& p : added) lines.at(p) = 1;
}

// The lines of `lines` that are long and mostly deeper than `high_m`, made tight against diagonal
// neighbours; empty when none is.
image::Mask long_and_deep(const image::Mask& lines, const image::Mask& mask,
                          const image::Image<float>& valley_m, float high_m, float least_px) {
  const auto [labels, pieces] = image::components(lines, image::Neighbours::kEight);
  std::vector<int> length(pieces.size(), 0);
  std::vector<int> deep(pieces.size(), 0);  // less those that are not
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const int line = labels.at(v, u);
      if (line == 0) continue;
      ++length[line];
      if (mask.at(v, u) != 0) deep[line] += valley_m.at(v, u) > high_m ? 1 : -1;
    }
  }
  image::Mask seams(mask.size(), 0);
  bool any = false;
  for (int v = 1; v + 1 < mask.height(); ++v) {
    for (int u = 1; u + 1 < mask.width(); ++u) {
      const int line = labels.at(v, u);
      if (line == 0 || static_cast<float>(length[line]) < least_px || deep[line] < 0) continue;
      any = true;
      seams.at(v, u) = 1;
      const bool left = labels.at(v + 1, u - 1) == line && labels.at(v, u - 1) != line;
      const bool right = labels.at(v + 1, u + 1) == line && labels.at(v, u + 1) != line;
      if ((left || right) && labels.at(v + 1, u) != line) seams.at(v + 1, u) = 1;
    }
  }
  return any ? seams : image::Mask();
}

// Adds the mask's slits that the seams run through, and what the seams cut off the mask that is no
// strand: thin pieces beside those slits.
void add_slits(const image::Mask& mask, const image::Mask& closed, float narrow_px,
               image::Mask& seams) {
  const int half = std::max(1, static_cast<int>(0.5F * kSliverWidths * narrow_px));
  image::Mask rest = mask.clone();
  image::erase(rest, seams);
  const image::Mask thick = image::dilated(image::eroded(rest, half), half);
  const image::Mask near = image::dilated(seams, half);
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const bool sliver = rest.at(v, u) != 0 && thick.at(v, u) == 0;
      const bool slit = closed.at(v, u) != 0 && mask.at(v, u) == 0;
      if (near.at(v, u) != 0 && (sliver || slit)) seams.at(v, u) = 1;
    }
  }
}

// The seams of a mask that has `wide` parts; `closed` is the mask without its slits.
image::Mask seams_in(const ValleyView& view, const image::Mask& wide, float narrow_px,
                     const Frame& frame) {
  const Valleys valleys = measure_valleys(view, frame);
  if (valleys.radius_m <= 0) return {};
  const float low_m = std::max(kNoiseLow * valleys.noise_m, kRadiiLow * valleys.radius_m);
  const float high_m = std::max(kNoiseHigh * valleys.noise_m, kRadiiHigh * valleys.radius_m);
  image::Mask band = view.closed.clone();
  if (!keep_valleys(view.mask, wide, valleys.depth_m, low_m, band)) return {};
  image::Mask lines = thin(band);
  const float spur_px = kSpurWidths * view.width_px;
  prune(lines, view.mask, valleys.depth_m, high_m, spur_px, 0);
  prune(lines, view.mask, valleys.depth_m, high_m, spur_px, kRungWidths * view.width_px);
  run_out(lines, view.mask, view.width_px);
  image::Mask seams =
      long_and_deep(lines, view.mask, valleys.depth_m, high_m, kShortestWidths * view.width_px);
  if (!seams.empty()) add_slits(view.mask, view.closed, narrow_px, seams);
  return seams;
}

}  // namespace

image::Mask find_seams(const image::Mask& mask, const SeamScale& scale, const Frame& frame) {
  const int slit = std::max(1, static_cast<int>(std::lround(0.5F * kSlitWidths * scale.narrow_px)));
  const image::Mask closed = image::eroded(image::dilated(mask, slit), slit);
  const image::Mask wide = wide_parts(closed, scale);
  if (wide.empty()) return {};
  const int margin = valley_margin(scale.width_px);
  const image::Rect inner = image::box_of(wide);
  const image::Rect box = image::grown(inner, margin) & image::all_of(mask.size());
  const ValleyView view{mask.part(box), closed.part(box), inner - box.corner(),
                        scale.offset_px + box.corner(), scale.width_px};
  const image::Mask found = seams_in(view, wide.part(box), scale.narrow_px, frame);
  if (found.empty()) return {};
  image::Mask seams(mask.size(), 0);
  for (int v = 0; v < box.height; ++v) {
    std::copy_n(found.row(v), box.width, seams.row(box.y + v) + box.x);
  }
  return seams;
}

}  // namespace flowdlo::path
