#include "strand/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/channel.hpp"
#include "field/region.hpp"

namespace flowdlo::strand {
namespace {

constexpr float kReach = 1.3F;       // radii from an axis that belong to a strand
constexpr float kSameWidths = 1.5F;  // of arclength within which two points are one strand's
constexpr float kNoRope = 9;
constexpr std::size_t kMostStrands = 4;  // one above another
constexpr std::size_t kTipPoints = 6;    // of which one has to show

/// What one strand is at one pixel.
struct Layer {
  int strand = -1;
  float along = 0;
  float distance = 0;  // pixels
  float radius = 1;
  float surface_m = 0;
  float angle = 0;
  float off = 0;
  Seen seen = Seen::kNo;

  [[nodiscard]] bool covers() const { return distance < radius; }
};

struct Layers {
  std::array<Layer, kMostStrands> all;
  std::size_t count = 0;

  void add(const Layer& layer) {
    for (std::size_t i = 0; i < count; ++i) {
      Layer& known = all[i];
      if (known.strand != layer.strand || std::abs(known.along - layer.along) > kSameWidths)
        continue;
      if (layer.distance < known.distance) known = layer;
      return;
    }
    if (count < kMostStrands) all[count++] = layer;
  }

  /// The one that shows first.
  void sort() {
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Layer& a, const Layer& b) {
                if (a.covers() != b.covers()) return a.covers();
                if (a.covers()) return a.surface_m < b.surface_m;
                return a.distance / a.radius < b.distance / b.radius;
              });
  }
};

float angle_at(const std::vector<AxisPoint>& points, std::size_t i) {
  const AxisPoint& a = points[i > 2 ? i - 2 : 0];
  const AxisPoint& b = points[std::min(points.size() - 1, i + 2)];
  return std::atan2(b.v - a.v, b.u - a.u);
}

class Canvas {
 public:
  Canvas(const cv::Size& size, float focal_px)
      : size_(size), focal_px_(focal_px), layers_(static_cast<std::size_t>(size.area())) {}

  void paint(const Strand& strand, int id) {
    for (std::size_t i = 0; i < strand.points.size(); ++i) paint(strand.points, i, id);
  }

  void sort() {
    for (Layers& layers : layers_) layers.sort();
  }

  /// Null: no strand shows.
  [[nodiscard]] const Layer* top(int u, int v) const {
    if (u < 0 || v < 0 || u >= size_.width || v >= size_.height) return nullptr;
    const Layers& layers = at(u, v);
    return layers.count > 0 && layers.all[0].seen != Seen::kNo ? &layers.all[0] : nullptr;
  }
  [[nodiscard]] const Layer* under(int u, int v) const {
    const Layers& layers = at(u, v);
    if (top(u, v) == nullptr) return nullptr;
    for (std::size_t i = 1; i < layers.count; ++i) {
      if (layers.all[i].seen == Seen::kUnder && layers.all[0].covers()) return &layers.all[i];
    }
    return nullptr;
  }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] const Layers& at(int u, int v) const { return layers_[index(u, v)]; }

  void paint(const std::vector<AxisPoint>& points, std::size_t i, int id) {
    const AxisPoint& point = points[i];
    const float reach = kReach * point.radius_px;
    const int left = std::max(0, static_cast<int>(std::ceil(point.u - reach)));
    const int right = std::min(size_.width - 1, static_cast<int>(std::floor(point.u + reach)));
    const int top = std::max(0, static_cast<int>(std::ceil(point.v - reach)));
    const int bottom = std::min(size_.height - 1, static_cast<int>(std::floor(point.v + reach)));
    if (left > right || top > bottom) return;
    const float angle = angle_at(points, i);
    const float left_u = -std::sin(angle);
    const float left_v = std::cos(angle);
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u) {
        const float du = static_cast<float>(u) - point.u;
        const float dv = static_cast<float>(v) - point.v;
        const float distance = std::hypot(du, dv);
        if (distance > reach) continue;
        const float across = distance / point.radius_px;
        // The surface bulges by the radius towards the camera; a pixel's depth is of that order.
        const float bulge = across < 1 ? std::sqrt(1 - across * across) : 0;
        layers_[index(u, v)].add({id, point.along_widths, distance, point.radius_px,
                                  point.depth_m - bulge * radius_m(point), angle,
                                  (left_u * du + left_v * dv) / point.radius_px, point.seen});
      }
    }
  }

  [[nodiscard]] float radius_m(const AxisPoint& point) const {
    return point.radius_px * point.depth_m / focal_px_;
  }

  cv::Size size_;
  float focal_px_;
  std::vector<Layers> layers_;
};

bool shows(const std::vector<AxisPoint>& points, bool at_begin) {
  const std::size_t count = std::min(kTipPoints, points.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (points[at_begin ? i : points.size() - 1 - i].seen == Seen::kYes) return true;
  }
  return false;
}

bool other_strand(const Layer& a, const Layer& b) {
  return a.strand != b.strand || std::abs(a.along - b.along) > kSameWidths;
}

/// Whether something nearer ends beside this pixel, or here before something farther.
bool on_edge(const Canvas& canvas, int u, int v) {
  const Layer* const here = canvas.top(u, v);
  if (here == nullptr || !here->covers()) return false;
  for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const Layer* const there = canvas.top(u + du, v + dv);
    if (there != nullptr && there->covers() && other_strand(*here, *there)) return true;
  }
  return false;
}

float nearness(float distance, float scale) {
  return std::exp(-(distance / scale) * (distance / scale));
}

void paint_tip(const AxisPoint& end, cv::Mat& field) {
  const float scale = field::kTipWidths * 2 * end.radius_px;
  const float reach = 3 * scale;
  for (int v = std::max(0, static_cast<int>(end.v - reach));
       v <= std::min(field.rows - 1, static_cast<int>(end.v + reach)); ++v) {
    for (int u = std::max(0, static_cast<int>(end.u - reach));
         u <= std::min(field.cols - 1, static_cast<int>(end.u + reach)); ++u) {
      float& tip = field.ptr<float>(v)[u * field::kChannels + field::kTip];
      tip = std::max(
          tip, nearness(std::hypot(static_cast<float>(u) - end.u, static_cast<float>(v) - end.v),
                        scale));
    }
  }
}

std::vector<const AxisPoint*> visible_ends(const std::vector<Strand>& strands) {
  std::vector<const AxisPoint*> ends;
  for (const Strand& strand : strands) {
    if (strand.points.empty()) continue;
    if (strand.begins && shows(strand.points, true)) ends.push_back(&strand.points.front());
    if (strand.ends && shows(strand.points, false)) ends.push_back(&strand.points.back());
  }
  return ends;
}

}  // namespace

std::vector<cv::Point2f> visible_tips(const std::vector<Strand>& strands) {
  std::vector<cv::Point2f> tips;
  for (const AxisPoint* end : visible_ends(strands)) tips.emplace_back(end->u, end->v);
  return tips;
}

Targets targets_of(const std::vector<Strand>& strands, float focal_px, const cv::Size& size) {
  Canvas canvas(size, focal_px);
  // A curve may come back into an image: stretches of one rope differ in where they lie along it.
  for (const Strand& strand : strands) canvas.paint(strand, strand.rope);
  canvas.sort();
  Targets targets;
  targets.field = cv::Mat::zeros(size, CV_32FC(field::kChannels));
  targets.along = cv::Mat::zeros(size, CV_32F);
  targets.off = cv::Mat(size, CV_32F, cv::Scalar(kNoRope));
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const Layer* const top = canvas.top(u, v);
      if (top == nullptr) continue;
      float* const to = targets.field.ptr<float>(v) + u * field::kChannels;
      to[field::kCentre] = nearness(top->distance, field::kCentreWidths * 2 * top->radius);
      to[field::kCos] = std::cos(2 * top->angle);
      to[field::kSin] = std::sin(2 * top->angle);
      to[field::kWidth] = std::log2(2 * top->radius / field::kRope_px);
      to[field::kRope] = top->covers() ? 1.0F : 0.0F;
      to[field::kEdge] = on_edge(canvas, u, v) ? 1.0F : 0.0F;
      targets.along.at<float>(v, u) = top->along;
      targets.off.at<float>(v, u) = top->off;
      const Layer* const under = canvas.under(u, v);
      if (under == nullptr) continue;
      to[field::kUnder] = nearness(under->distance, field::kCentreWidths * 2 * under->radius);
      to[field::kUnderCos] = std::cos(2 * under->angle);
      to[field::kUnderSin] = std::sin(2 * under->angle);
    }
  }
  for (const AxisPoint* end : visible_ends(strands)) paint_tip(*end, targets.field);
  return targets;
}

}  // namespace flowdlo::strand
