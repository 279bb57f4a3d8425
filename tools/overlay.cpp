#include "overlay.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "overlay_legend.hpp"
#include "overlay_style.hpp"
#include "projected_curve.hpp"

namespace flowdlo::tools {
namespace {

constexpr int kNarrowest_px = 480;
constexpr int kLongest_px = 4096;
constexpr int kShift = 4;  // fixed-point bits of OpenCV's drawing functions

// Whole multiples only, so that every pixel of the camera stays a square.
int zoom_of(const Frame& frame) {
  const int wanted = (kNarrowest_px + frame.width - 1) / frame.width;
  return std::max(1, std::min(wanted, kLongest_px / std::max(frame.width, frame.height)));
}

cv::Mat mask_of(const Frame& frame) {
  const cv::Mat view(frame.height, frame.width, CV_8UC1,
                     const_cast<std::uint8_t*>(frame.mask.data()));  // only read
  return view > 127;
}

// Paler and darker than the image, so that the curve stands out.
cv::Mat background(const Frame& frame, const cv::Mat& mask) {
  cv::Mat picture;
  if (frame.color_bgr.empty()) {
    cv::cvtColor(mask, picture, cv::COLOR_GRAY2BGR);
    picture.convertTo(picture, -1, 0.35, 40);
    return picture;
  }
  const cv::Mat color(frame.height, frame.width, CV_8UC3,
                      const_cast<std::uint8_t*>(frame.color_bgr.data()));  // only read
  cv::Mat gray;
  cv::cvtColor(color, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(gray, gray, cv::COLOR_GRAY2BGR);
  cv::addWeighted(color, 0.45, gray, 0.25, 0, picture);
  return picture;
}

// The strand field over `picture`: how near an axis is says how much of its colour a pixel takes,
// the direction says which colour; tips are white. Channels are engine/field/channel.hpp's.
void tint(cv::Mat& picture, const SeenStrands& strands) {
  enum Channel : std::size_t { kCentre, kCos, kSin, kTip };
  if (strands.channels.empty()) return;
  const cv::Size seen(strands.width, strands.height);
  const auto pixels = static_cast<std::size_t>(seen.area());
  cv::Mat paint(seen, CV_32FC4);  // BGR weighed, and the weight
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto at = [&](Channel channel) { return strands.channels[channel * pixels + i]; };
    const float length = std::max(1e-3F, std::hypot(at(kCos), at(kSin)));
    const float tip = std::clamp(at(kTip), 0.0F, 1.0F);
    const float weight = std::clamp(std::max(at(kCentre), tip), 0.0F, 1.0F);
    const cv::Vec3f color = (1 - tip) * cv::Vec3f(127.5F * (1 + at(kCos) / length),
                                                  127.5F * (1 + at(kSin) / length), 255) +
                            tip * cv::Vec3f::all(255);
    paint.ptr<cv::Vec4f>()[i] = {weight * color[0], weight * color[1], weight * color[2], weight};
  }
  const cv::Rect whole(strands.first_u, strands.first_v,
                       std::max(1, cvRound(static_cast<float>(seen.width) / strands.scale_u)),
                       std::max(1, cvRound(static_cast<float>(seen.height) / strands.scale_v)));
  const cv::Rect part = whole & cv::Rect({0, 0}, picture.size());
  if (part.empty()) return;
  cv::resize(paint, paint, whole.size(), 0, 0, cv::INTER_AREA);
  paint = paint(part - whole.tl());
  for (int v = 0; v < part.height; ++v) {
    for (int u = 0; u < part.width; ++u) {
      auto& pixel = picture.at<cv::Vec3b>(part.y + v, part.x + u);
      const auto& over = paint.at<cv::Vec4f>(v, u);
      for (int k = 0; k < 3; ++k) {
        pixel[k] =
            cv::saturate_cast<std::uint8_t>((1 - over[3]) * static_cast<float>(pixel[k]) + over[k]);
      }
    }
  }
}

// The mask's border pixels, as wide as the style's lines and with soft sides, [h, w] u8: how much
// of the outline's colour each pixel takes. An operation on the image: a mask of a million pieces
// costs no more than one of one.
cv::Mat outline_of(const cv::Mat& mask, const OverlayStyle& style) {
  cv::Mat inner;
  const cv::Mat cross = cv::getStructuringElement(cv::MORPH_CROSS, {3, 3});
  cv::erode(mask, inner, cross, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat outline = mask - inner;
  if (style.outline_px > 1) {
    cv::dilate(outline, outline,
               cv::getStructuringElement(cv::MORPH_ELLIPSE, {style.outline_px, style.outline_px}));
  }
  constexpr float kBeside = 0.18F;  // of the colour that neighbours take: what smooths a line drawn
  constexpr float kAslant = 0.08F;
  const cv::Mat soft = (cv::Mat_<float>(3, 3) << kAslant, kBeside, kAslant,  //
                        kBeside, 1, kBeside,                                 //
                        kAslant, kBeside, kAslant);
  cv::filter2D(outline, outline, CV_8U, soft);
  return outline;
}

void draw_mask_outline(cv::Mat& picture, const cv::Mat& mask, const OverlayStyle& style) {
  constexpr float kOpacity = 0.6F;
  const cv::Mat outline = outline_of(mask, style);
  for (int v = 0; v < picture.rows; ++v) {
    const auto* share = outline.ptr<std::uint8_t>(v);
    auto* pixel = picture.ptr<cv::Vec3b>(v);
    for (int u = 0; u < picture.cols; ++u) {
      if (share[u] == 0) continue;
      const float opacity = kOpacity * static_cast<float>(share[u]) / 255;
      for (int c = 0; c < 3; ++c) {
        const auto line = static_cast<float>(kMaskOutlineColor[c]);
        pixel[u][c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[u][c]) +
                                                      opacity * (line - pixel[u][c]));
      }
    }
  }
}

void stroke(cv::Mat& picture, const std::vector<cv::Point2f>& points, const cv::Scalar& color,
            int thickness_px) {
  std::vector<cv::Point> fixed_point;
  for (const auto& point : points) {
    fixed_point.emplace_back(cvRound(point.x * (1 << kShift)), cvRound(point.y * (1 << kShift)));
  }
  cv::polylines(picture, fixed_point, false, color, thickness_px, cv::LINE_AA, kShift);
}

// A curve's colours: where visible points back it, and where none do.
struct Paint {
  cv::Scalar supported;
  cv::Scalar bridged;

  [[nodiscard]] const cv::Scalar& at(const Estimate& estimate, std::size_t node) const {
    return estimate.support[node] != 0 ? supported : bridged;
  }
};

// Each node colours the curve half way to its neighbours.
void draw_colored(cv::Mat& picture, const ProjectedCurve& curve, const Estimate& estimate,
                  double from, double to, int line_px, const Paint& paint) {
  const auto first = static_cast<int>(std::lround(std::max(from, 0.0)));
  for (int node = first; node < kNodes && node - 0.5 < to; ++node) {
    stroke(picture, curve.piece(std::max(from, node - 0.5), std::min(to, node + 0.5)),
           paint.at(estimate, static_cast<std::size_t>(node)), line_px);
  }
}

// The strand that is above at a crossing, once more: its rim cuts the lower one. The flatter the
// crossing, the longer the cut.
void draw_above(cv::Mat& picture, const ProjectedCurve& curve, const Estimate& estimate,
                double position, float sine, const OverlayStyle& style, const Paint& paint) {
  const int rimmed_px = style.line_px + 2 * style.rim_px;
  const float flatness = 1.0F / std::max(sine, 0.25F);
  const float half_px = static_cast<float>(rimmed_px) * (0.5F + flatness);
  const auto reach_px = half_px + static_cast<float>(rimmed_px);  // covers the rim's round ends
  stroke(picture,
         curve.piece(curve.advanced(position, -half_px), curve.advanced(position, half_px)),
         kRimColor, rimmed_px);
  draw_colored(picture, curve, estimate, curve.advanced(position, -reach_px),
               curve.advanced(position, reach_px), style.line_px, paint);
}

void draw_curve(cv::Mat& picture, const ProjectedCurve& curve, const Estimate& estimate,
                const OverlayStyle& style, const Paint& paint) {
  const int rimmed_px = style.line_px + 2 * style.rim_px;
  stroke(picture, curve.piece(0, kNodes - 1), kRimColor, rimmed_px);
  draw_colored(picture, curve, estimate, 0, kNodes - 1, style.line_px, paint);
  for (const auto& crossing : curve.crossings()) {
    draw_above(picture, curve, estimate, crossing.upper, crossing.sine, style, paint);
  }
}

// From the last node of a ring on to the first.
void close(cv::Mat& picture, const ProjectedCurve& curve, const OverlayStyle& style,
           const Paint& paint) {
  const std::vector<cv::Point2f> gap{curve.nodes_px().back(), curve.nodes_px().front()};
  stroke(picture, gap, kRimColor, style.line_px + 2 * style.rim_px);
  stroke(picture, gap, paint.supported, style.line_px);
}

// Only where they do not run together.
void draw_nodes(cv::Mat& picture, const ProjectedCurve& curve, const OverlayStyle& style) {
  constexpr float kLeastSpacing = 3.0F;  // in line widths
  if (curve.length_px() < kLeastSpacing * static_cast<float>(style.line_px * kNodes)) return;
  const int radius =
      OverlayStyle::rounded(0.36F * static_cast<float>(style.line_px * (1 << kShift)));
  for (const auto& node : curve.nodes_px()) {
    const cv::Point center(cvRound(node.x * (1 << kShift)), cvRound(node.y * (1 << kShift)));
    cv::circle(picture, center, radius, kRimColor, cv::FILLED, cv::LINE_AA, kShift);
  }
}

// Beyond the end, so that the rope's tip stays in sight; inside the picture.
cv::Point marker_center(const cv::Point2f& end, const cv::Point2f& inner, const cv::Size& picture,
                        int radius_px) {
  const auto outward = end - inner;
  const float length = std::max(std::hypot(outward.x, outward.y), 1.0e-3F);
  const auto center = end + outward * (static_cast<float>(radius_px) * 1.5F / length);
  const auto inside = [radius_px](float at, int size) {
    return std::clamp(cvRound(at), std::min(radius_px, size - 1),
                      std::max(0, size - 1 - radius_px));
  };
  if (picture.width <= 2 * radius_px || picture.height <= 2 * radius_px) return end;
  return {inside(center.x, picture.width), inside(center.y, picture.height)};
}

void draw_marker(cv::Mat& picture, const cv::Point& center, const char* letter,
                 const cv::Scalar& fill, const cv::Scalar& ink, const OverlayStyle& style) {
  const int radius = style.marker_radius_px;
  cv::circle(picture, center, radius, fill, cv::FILLED, cv::LINE_AA);
  cv::circle(picture, center, radius, ink, std::max(1, style.outline_px), cv::LINE_AA);
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  const double font_scale = 0.45 * style.scale;
  const int thickness = OverlayStyle::rounded(1.3F * style.scale);
  int baseline = 0;
  const auto size = cv::getTextSize(letter, kFont, font_scale, thickness, &baseline);
  cv::putText(picture, letter, {center.x - size.width / 2, center.y + size.height / 2}, kFont,
              font_scale, ink, thickness, cv::LINE_AA);
}

struct EndMarkers {
  cv::Point first;
  cv::Point last;
};

EndMarkers end_markers(const ProjectedCurve& curve, const cv::Size& picture,
                       const OverlayStyle& style) {
  const auto& nodes = curve.nodes_px();
  const int radius = style.marker_radius_px;
  return {marker_center(nodes[0], nodes[2], picture, radius),
          marker_center(nodes[kNodes - 1], nodes[kNodes - 3], picture, radius)};
}

// What the legend must not cover.
void mark_drawn(cv::Mat& rope, const ProjectedCurve& curve, const EndMarkers& markers,
                const OverlayStyle& style) {
  const cv::Scalar drawn(255);
  stroke(rope, curve.piece(0, kNodes - 1), drawn, 4 * style.line_px);
  for (const auto& center : {markers.first, markers.last}) {
    cv::circle(rope, center, 2 * style.marker_radius_px, drawn, cv::FILLED);
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
  const cv::Scalar& color = rope_color(rope);
  return {color, 0.5 * color};
}

}  // namespace

cv::Mat draw_overlay(const Frame& frame, const Estimate& estimate, const std::string& device,
                     const SeenStrands* strands) {
  const int zoom = zoom_of(frame);
  const cv::Size size(frame.width * zoom, frame.height * zoom);
  const cv::Mat mask = mask_of(frame);
  cv::Mat picture;
  cv::Mat rope;
  cv::Mat below = background(frame, mask);
  if (strands != nullptr) tint(below, *strands);
  cv::resize(below, picture, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(mask, rope, size, 0, 0, cv::INTER_NEAREST);

  const OverlayStyle style(size.width);
  draw_mask_outline(picture, rope, style);
  const ProjectedCurve curve(estimate.nodes, frame.intrinsics, static_cast<float>(zoom));
  if (curve.drawable()) {
    const Paint paint{kSupportedColor, kBridgedColor};
    if (strands == nullptr) draw_curve(picture, curve, estimate, style, paint);
    draw_nodes(picture, curve, style);
    const auto markers = end_markers(curve, size, style);
    const cv::Scalar white(255, 255, 255);
    draw_marker(picture, markers.first, "A", white, kRimColor, style);
    draw_marker(picture, markers.last, "B", kRimColor, white, style);
    mark_drawn(rope, curve, markers, style);
  }
  draw_legend(picture, rope, estimate, device, style);
  return picture;
}

cv::Mat draw_field(const Frame& frame, const SeenStrands& strands) {
  cv::Mat picture = background(frame, mask_of(frame));
  tint(picture, strands);
  return picture;
}

cv::Mat draw_failure(const Frame& frame, const std::string& words) {
  const int zoom = zoom_of(frame);
  const cv::Size size(frame.width * zoom, frame.height * zoom);
  const cv::Mat mask = mask_of(frame);
  cv::Mat picture;
  cv::Mat rope;
  cv::resize(background(frame, mask), picture, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(mask, rope, size, 0, 0, cv::INTER_NEAREST);
  const OverlayStyle style(size.width);
  draw_mask_outline(picture, rope, style);
  draw_legend(picture, rope, words, style);
  return picture;
}

cv::Mat draw_overlay(const Frame& frame, const Ropes& ropes, const std::string& device) {
  const int zoom = zoom_of(frame);
  const cv::Size size(frame.width * zoom, frame.height * zoom);
  const cv::Mat mask = mask_of(frame);
  cv::Mat picture;
  cv::Mat covered;
  cv::resize(background(frame, mask), picture, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(mask, covered, size, 0, 0, cv::INTER_NEAREST);
  const OverlayStyle style(size.width);
  draw_mask_outline(picture, covered, style);

  std::vector<ProjectedCurve> curves;
  for (const Estimate& rope : ropes.ropes) {
    curves.emplace_back(rope.nodes, frame.intrinsics, static_cast<float>(zoom));
  }
  for (std::size_t i = curves.size(); i-- > 0;) {  // the longest last: above the others
    if (!curves[i].drawable()) continue;
    draw_curve(picture, curves[i], ropes.ropes[i], style, paint_of(i));
    if (ropes.ropes[i].closed) close(picture, curves[i], style, paint_of(i));
  }
  for (const RopeCrossing& crossing : ropes.crossings) {
    const auto over = static_cast<std::size_t>(crossing.over);
    if (over >= curves.size() || !curves[over].drawable()) continue;
    constexpr float kUsualSine = 0.7F;
    draw_above(picture, curves[over], ropes.ropes[over],
               position_at(ropes.ropes[over].nodes, crossing.over_at_m), kUsualSine, style,
               paint_of(over));
  }
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].drawable() || ropes.ropes[i].closed) continue;
    const auto markers = end_markers(curves[i], size, style);
    const std::string number = std::to_string(i);
    draw_marker(picture, markers.first, number.c_str(), rope_color(i), kRimColor, style);
    draw_marker(picture, markers.last, number.c_str(), kRimColor, rope_color(i), style);
    mark_drawn(covered, curves[i], markers, style);
  }
  draw_legend(picture, covered, ropes, device, style);
  return picture;
}

}  // namespace flowdlo::tools
