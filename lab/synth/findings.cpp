#include "synth/findings.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::synth {
namespace {

constexpr double kGap = 3.0;         // radii without mask that make a gap
constexpr double kHole = 6.0;        // radii without depth that make a hole
constexpr double kLeastDepth = 0.8;  // share of masked rope pixels
constexpr double kTouch = 10.0;      // radii within 2.4 radii: a crossing is shorter
constexpr double kTipsTouch = 3.0;   // radii between the centres of two ends

// A short piece of the rope.
struct Piece {
  std::size_t sample = 0;  ///< its middle
  int seen = 0;            ///< pixels that see it
  int masked = 0;
  int deep = 0;          ///< of these, with depth
  bool covered = false;  ///< has mask, its own or that of a strand above
  bool outside = false;
};

// One radius long, and at least one and a half pixels.
std::vector<Piece> pieces_of(const View& view, const Picture& ideal, std::span<const float> depth_m,
                             std::span<const std::uint8_t> mask) {
  const auto& points = view.curves.front().points;
  double least_px = 1e9;
  for (const Vector3d& p : points) {
    least_px = std::min(least_px, view.curves.front().step_m * view.camera.fx / p.z());
  }
  const auto each = static_cast<std::size_t>(std::clamp(std::ceil(1.5 / least_px), 2.0, 64.0));
  std::vector<Piece> pieces((points.size() + each - 1) / each);
  for (const Surface& surface : ideal.surfaces) {
    if (surface.thing != kRopeThing || surface.rope != 0) continue;
    Piece& piece =
        pieces[std::min(pieces.size() - 1, static_cast<std::size_t>(surface.along) / each)];
    ++piece.seen;
    if (mask[surface.pixel] <= 127) continue;
    ++piece.masked;
    piece.deep += depth_m[surface.pixel] > 0 ? 1 : 0;
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Piece& piece = pieces[k];
    piece.sample = std::min(points.size() - 1, k * each + each / 2);
    const Vector2d at = view.project(points[piece.sample]);
    const int u = static_cast<int>(std::lround(at.x()));
    const int v = static_cast<int>(std::lround(at.y()));
    piece.outside = u < 0 || v < 0 || u >= view.sensor->width || v >= view.sensor->height;
    piece.covered = piece.masked > 0;
    if (!piece.outside && !piece.covered) {
      piece.covered = mask[static_cast<std::size_t>(v * view.sensor->width + u)] > 127;
    }
  }
  return pieces;
}

// Runs of pieces of one kind: [from, to).
template <class Test>
std::vector<std::pair<std::size_t, std::size_t>> runs(const std::vector<Piece>& pieces, Test test) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!test(pieces[i])) continue;
    std::size_t end = i;
    while (end < pieces.size() && test(pieces[end])) ++end;
    found.emplace_back(i, end);
    i = end;
  }
  return found;
}

bool has_turn(const View& view, const std::vector<Piece>& pieces, std::size_t from, std::size_t to,
              double radius_m) {
  const auto& points = view.curves.front().points;
  const double first = points[pieces[from].sample].z();
  const double last = points[pieces[to - 1].sample].z();
  for (std::size_t i = from; i < to; ++i) {
    const double z = points[pieces[i].sample].z();
    if (z > std::max(first, last) + radius_m || z < std::min(first, last) - radius_m) return true;
  }
  return false;
}

void find_gaps(const std::vector<Piece>& pieces, double piece_m, double radius_m, Meta& meta) {
  const auto bare = [](const Piece& piece) { return !piece.covered; };
  for (const auto& [from, to] : runs(pieces, bare)) {
    const double length = static_cast<double>(to - from) * piece_m;
    meta.longest_gap_m = std::max(meta.longest_gap_m, length);
    if (length <= kGap * radius_m) continue;
    const bool inner = from > 0 && to < pieces.size();
    (inner ? meta.defects.gap : meta.defects.hidden_end) = true;
  }
}

void find_holes(const View& view, const std::vector<Piece>& pieces, double piece_m, double radius_m,
                Meta& meta) {
  const auto empty = [](const Piece& piece) {
    return piece.masked > 0 && piece.deep * 4 <= piece.masked;
  };
  for (const auto& [from, to] : runs(pieces, empty)) {
    const double length = static_cast<double>(to - from) * piece_m;
    meta.longest_hole_m = std::max(meta.longest_hole_m, length);
    if (length <= kHole * radius_m) continue;
    meta.defects.depth_holes = true;
    if (has_turn(view, pieces, from, to, 0.5 * radius_m)) meta.defects.depth_turn = true;
  }
}

}  // namespace

void find(const View& view, const Rope& rope, const Picture& ideal, std::span<const float> depth_m,
          std::span<const std::uint8_t> mask, Meta& meta) {
  const auto pieces = pieces_of(view, ideal, depth_m, mask);
  const double piece_m = view.curves.front().length_m() / static_cast<double>(pieces.size());
  int seen = 0;
  int masked = 0;
  int deep = 0;
  for (const Piece& piece : pieces) {
    seen += piece.seen > 0 ? 1 : 0;
    masked += piece.masked;
    deep += piece.deep;
    meta.defects.outside = meta.defects.outside || piece.outside;
  }
  meta.visible_share = static_cast<double>(seen) / static_cast<double>(pieces.size());
  meta.depth_share = masked > 0 ? static_cast<double>(deep) / masked : 0;
  find_gaps(pieces, piece_m, rope.radius_m, meta);
  find_holes(view, pieces, piece_m, rope.radius_m, meta);
  if (meta.depth_share < kLeastDepth) meta.defects.depth_holes = true;

  std::vector<Vector2d> projected;
  for (std::size_t i = 0; i < view.curves.front().points.size(); i += 2) {
    projected.push_back(view.project(view.curves.front().points[i]));
  }
  meta.crossings = static_cast<int>(crossings(projected).size());
  meta.intersection = meta.crossings > 0;
  meta.radius_m = rope.radius_m;
  meta.length_m = view.curves.front().length_m();
  meta.least_bend_radius_m = least_bend_radius_m(view.curves.front(), rope.radius_m);
  meta.width_px = 2 * rope.radius_m * view.camera.fx / view.distance_m;
  const double tips =
      (view.curves.front().points.front() - view.curves.front().points.back()).norm();
  meta.defects.touch =
      nearness(view.curves.front(), rope.radius_m).contact_m > kTouch * rope.radius_m ||
      tips < kTipsTouch * rope.radius_m;
  meta.defects.coil = rope.coil;
}

void note(const Faults& faults, std::span<const Thing> things, const Picture& ideal,
          std::span<const float> depth_m, std::span<const std::uint8_t> mask, Meta& meta) {
  Defects& defects = meta.defects;
  std::vector<bool> in_view(things.size(), false);
  for (const Surface& surface : ideal.surfaces) {
    if (surface.thing != kRopeThing) in_view[surface.thing] = true;
  }
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (!in_view[i]) continue;
    defects.bars = defects.bars || things[i].kind == ThingKind::kBar;
    defects.hand = defects.hand || things[i].kind == ThingKind::kHand;
    defects.clutter = defects.clutter || things[i].kind == ThingKind::kClutter;
    const bool in_front = things[i].kind == ThingKind::kBar || things[i].kind == ThingKind::kHand;
    meta.occluders += in_front ? 1 : 0;
  }
  int stretch = 0;  // pixels of black or shiny stretches without depth
  int stray = 0;    // mask beyond the rope
  int bare = 0;     // rope without mask
  const auto held = [](const std::vector<Stretch>& all, const Surface& seen) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Stretch& s) { return s.holds(seen.rope, seen.along); });
  };
  for (const Surface& surface : ideal.surfaces) {
    if (surface.thing != kRopeThing) continue;
    bare += mask[surface.pixel] <= 127 ? 1 : 0;
    if (depth_m[surface.pixel] > 0) continue;
    stretch += held(faults.depth.black, surface) || held(faults.depth.shiny, surface);
  }
  for (std::size_t i = 0; i < mask.size(); ++i) stray += mask[i] > 127 && ideal.mask[i] == 0;
  defects.black_or_shiny = stretch > 0;
  defects.depth_noise = faults.depth.noise;
  defects.flying_pixels = faults.depth.flying > 0;
  defects.edge_dropout = faults.depth.dropout > 0;
  defects.mask_ragged = faults.mask.ragged_px > 0 && stray + bare > 0;
  defects.mask_specks = faults.mask.specks > 0 && stray > 0;
  defects.mask_gaps = (!faults.mask.gaps.empty() || faults.mask.parted_px > 0) && bare > 0;
  defects.mask_shifted = faults.mask.shift_px != 0 && stray + bare > 0;
}

}  // namespace flowdlo::synth
