#include "overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "frame_picture.hpp"
#include "overlay_legend.hpp"
#include "overlay_style.hpp"
#include "pen.hpp"
#include "projected_curve.hpp"

namespace flowdlo::tools {
namespace {

using ColorPen = Pen<Color>;

// A curve's colours: where visible points back it, and where none do.
struct Paint {
  Color supported{};
  Color bridged{};

  [[nodiscard]] const Color& at(const Estimate& estimate, std::size_t node) const {
    return estimate.support[node] != 0 ? supported : bridged;
  }
};

// Each node colours the curve half way to its neighbours.
void draw_colored(ColorPen& pen, const ProjectedCurve& curve, const Estimate& estimate, double from,
                  double to, float line_px, const Paint& paint) {
  const auto first = static_cast<int>(std::lround(std::max(from, 0.0)));
  for (int node = first; node < kNodes && node - 0.5 < to; ++node) {
    pen.stroke(curve.piece(std::max(from, node - 0.5), std::min(to, node + 0.5)), line_px,
               paint.at(estimate, static_cast<std::size_t>(node)));
  }
}

// The strand that is above at a crossing, once more: its rim cuts the lower one. The flatter the
// crossing, the longer the cut.
void draw_above(ColorPen& pen, const ProjectedCurve& curve, const Estimate& estimate,
                double position, float sine, const OverlayStyle& style, const Paint& paint) {
  const float flatness = 1.0F / std::max(sine, 0.25F);
  const float half_px = style.rimmed_px() * (0.5F + flatness);
  const float reach_px = half_px + style.rimmed_px();  // covers the rim's round ends
  pen.stroke(curve.piece(curve.advanced(position, -half_px), curve.advanced(position, half_px)),
             style.rimmed_px(), kRimColor);
  draw_colored(pen, curve, estimate, curve.advanced(position, -reach_px),
               curve.advanced(position, reach_px), style.line_px, paint);
}

void draw_curve(ColorPen& pen, const ProjectedCurve& curve, const Estimate& estimate,
                const OverlayStyle& style, const Paint& paint) {
  pen.stroke(curve.nodes_px(), style.rimmed_px(), kRimColor);
  draw_colored(pen, curve, estimate, 0, kNodes - 1, style.line_px, paint);
  for (const auto& crossing : curve.crossings()) {
    draw_above(pen, curve, estimate, crossing.upper, crossing.sine, style, paint);
  }
}

// From the last node of a ring on to the first.
void close(ColorPen& pen, const ProjectedCurve& curve, const OverlayStyle& style,
           const Paint& paint) {
  const std::array gap{curve.nodes_px().back(), curve.nodes_px().front()};
  pen.stroke(gap, style.rimmed_px(), kRimColor);
  pen.stroke(gap, style.line_px, paint.supported);
}

// Only where they do not run together.
void draw_nodes(ColorPen& pen, const ProjectedCurve& curve, const OverlayStyle& style) {
  constexpr float kLeastSpacing = 1.75F;  // in line widths
  constexpr float kRadius = 0.3F;         // of a line's width
  if (curve.length_px() < kLeastSpacing * style.line_px * static_cast<float>(kNodes)) return;
  for (const Spot& node : curve.nodes_px()) pen.disc(node, kRadius * style.line_px, kRimColor);
}

// Beyond the end, so that the rope's tip stays in sight; inside the picture.
Spot marker_center(const Spot& end, const Spot& inner, const image::Size& picture,
                   float radius_px) {
  const Spot outward = end - inner;
  const float length = std::max(std::hypot(outward.x, outward.y), 1.0e-3F);
  const Spot center = end + (1.5F * radius_px / length) * outward;
  const auto inside = [radius_px](float at, int size) {
    const auto last = static_cast<float>(size - 1);
    return std::clamp(at, std::min(radius_px, last), std::max(0.0F, last - radius_px));
  };
  const auto narrowest = static_cast<float>(std::min(picture.width, picture.height));
  if (narrowest <= 2 * radius_px) return end;
  return {inside(center.x, picture.width), inside(center.y, picture.height)};
}

void draw_marker(ColorPen& pen, const Spot& center, const std::string& letter, const Color& fill,
                 const Color& ink, const OverlayStyle& style) {
  pen.disc(center, style.marker_radius_px, fill);
  pen.ring(center, style.marker_radius_px, style.outline_px, ink);
  const Lettering& lettering = style.on_markers;
  const Spot start{center.x - lettering.width_px(letter) / 2 + lettering.line_px / 2,
                   center.y + lettering.height_px / 2};
  pen.write(letter, start, lettering, ink);
}

struct EndMarkers {
  Spot first;
  Spot last;
};

EndMarkers end_markers(const ProjectedCurve& curve, const image::Size& picture,
                       const OverlayStyle& style) {
  const auto& nodes = curve.nodes_px();
  const float radius_px = style.marker_radius_px;
  return {marker_center(nodes[0], nodes[2], picture, radius_px),
          marker_center(nodes[kNodes - 1], nodes[kNodes - 3], picture, radius_px)};
}

// What the legend must not cover.
void mark_drawn(image::Mask& rope, const ProjectedCurve& curve, const EndMarkers& markers,
                const OverlayStyle& style) {
  constexpr std::uint8_t kDrawn = 255;
  Pen<std::uint8_t> pen(rope);
  pen.stroke(curve.nodes_px(), 3 * style.line_px, kDrawn);
  for (const Spot& center : {markers.first, markers.last}) {
    pen.disc(center, 2 * style.marker_radius_px, kDrawn);
  }
}

// Where along its nodes a rope has run that far, 0 to 63.
double position_at(const Centerline& nodes, float along_m) {
  double left = static_cast<double>(along_m);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double step = std::hypot(static_cast<double>(nodes[i].x - nodes[i - 1].x),
                                   static_cast<double>(nodes[i].y - nodes[i - 1].y),
                                   static_cast<double>(nodes[i].z - nodes[i - 1].z));
    if (left <= step) return static_cast<double>(i - 1) + left / std::max(step, 1.0e-9);
    left -= step;
  }
  return kNodes - 1;
}

Paint paint_of(std::size_t rope) {
  const Color& color = rope_color(rope);
  const auto half = [](std::uint8_t value) { return static_cast<std::uint8_t>(value / 2); };
  return {color, {half(color[0]), half(color[1]), half(color[2])}};
}

}  // namespace

support::Picture draw_overlay(const Frame& frame, const Estimate& estimate,
                              const std::string& device, const SeenStrands* strands) {
  Ground ground = ground_of(frame, strands);
  const image::Size size = ground.picture.size();
  const OverlayStyle style(size.width);
  const ProjectedCurve curve(estimate.nodes, frame.intrinsics, static_cast<float>(ground.zoom));
  if (curve.drawable()) {
    ColorPen pen(ground.picture);
    if (strands == nullptr) {
      draw_curve(pen, curve, estimate, style, {kSupportedColor, kBridgedColor});
    }
    draw_nodes(pen, curve, style);
    const auto markers = end_markers(curve, size, style);
    draw_marker(pen, markers.first, "A", kWhite, kRimColor, style);
    draw_marker(pen, markers.last, "B", kRimColor, kWhite, style);
    mark_drawn(ground.rope, curve, markers, style);
  }
  draw_legend(ground.picture, ground.rope, estimate, device, style);
  return ground.picture;
}

support::Picture draw_field(const Frame& frame, const SeenStrands& strands) {
  auto picture = paled(frame);
  tint(picture, strands);
  return picture;
}

support::Picture draw_failure(const Frame& frame, const std::string& words) {
  Ground ground = ground_of(frame);
  draw_legend(ground.picture, ground.rope, words, OverlayStyle(ground.picture.width()));
  return ground.picture;
}

support::Picture draw_overlay(const Frame& frame, const TrackedRopes& tracked,
                              const std::string& device) {
  const Ropes& ropes = tracked.found;
  Ground ground = ground_of(frame);
  const image::Size size = ground.picture.size();
  const OverlayStyle style(size.width);
  ColorPen pen(ground.picture);
  std::vector<ProjectedCurve> curves;
  for (const Estimate& rope : ropes.ropes) {
    curves.emplace_back(rope.nodes, frame.intrinsics, static_cast<float>(ground.zoom));
  }
  for (std::size_t i = curves.size(); i-- > 0;) {  // the longest last: above the others
    if (!curves[i].drawable()) continue;
    draw_curve(pen, curves[i], ropes.ropes[i], style, paint_of(paint_index(tracked, i)));
    if (ropes.ropes[i].closed) close(pen, curves[i], style, paint_of(paint_index(tracked, i)));
  }
  for (const RopeCrossing& crossing : ropes.crossings) {
    const auto over = static_cast<std::size_t>(crossing.over);
    if (over >= curves.size() || !curves[over].drawable()) continue;
    constexpr float kUsualSine = 0.7F;
    draw_above(pen, curves[over], ropes.ropes[over],
               position_at(ropes.ropes[over].nodes, crossing.over_at_m), kUsualSine, style,
               paint_of(paint_index(tracked, over)));
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].drawable() || ropes.ropes[i].closed) continue;
    const auto markers = end_markers(curves[i], size, style);
    const std::string name = std::to_string(shown_number(tracked, i));
    const Color& color = rope_color(paint_index(tracked, i));
    draw_marker(pen, markers.first, name, color, kRimColor, style);
    draw_marker(pen, markers.last, name, kRimColor, color, style);
    mark_drawn(ground.rope, curves[i], markers, style);
  }
  draw_legend(ground.picture, ground.rope, tracked, device, style);
  return ground.picture;
}

}  // namespace flowdlo::tools
