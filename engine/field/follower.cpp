#include "field/follower.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "field/channel.hpp"
#include "field/region.hpp"
#include "field/ridge.hpp"
#include "field/surface.hpp"

namespace flowdlo::field {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kFaint = 0.25F;        // least kCentre at which a line goes on
constexpr float kMostTurn = 0.18F;     // radians a pixel; more is another strand
constexpr float kMostShift_px = 0.5F;  // towards the ridge, a step
constexpr float kOneLine = 0.5F;       // radians between directions of one and the same ridge
constexpr float kStrandShare = 0.3F;   // of a strand's width: as far beside its axis it is the same
constexpr float kLeastReach_px = 1.5F;
constexpr int kOwn = 6;  // points that a line has just left behind
constexpr float kLeastLength_px = 0.75F * kRope_px;

/// Which line passes through each pixel, and in which direction.
class Marks {
 public:
  explicit Marks(const Channels& field) : marks_(field.size(), field.map(), Mark{}) {}

  /// What lies within `reach_px` of a line's point belongs to that line, unless to an earlier one.
  void set(const Vector2f& p, const Vector2f& along, float reach_px, int line, int index) {
    const image::Point middle = pixel_of(p);
    const float angle = std::atan2(along.y(), along.x());
    const auto reach = static_cast<int>(std::ceil(reach_px));
    for (int v = middle.y - reach; v <= middle.y + reach; ++v) {
      for (int u = middle.x - reach; u <= middle.x + reach; ++u) {
        const Vector2f off = Vector2f(static_cast<float>(u), static_cast<float>(v)) - p;
        Mark* const mark = marks_.find(v, u);
        if (mark == nullptr || off.norm() > reach_px) continue;
        if (mark->line < 0 || mark->just_left(line, index)) *mark = {line, index, angle};
      }
    }
  }

  /// Whether a line runs by here in that direction; not what `line` has just left behind.
  [[nodiscard]] bool taken(const Vector2f& p, const Vector2f& along, int line, int index) const {
    const image::Point pixel = pixel_of(p);
    if (!marks_.contains(pixel)) return true;
    const Mark* const mark = marks_.find(pixel.y, pixel.x);
    if (mark == nullptr || mark->line < 0 || mark->just_left(line, index)) return false;
    const float sine = along.y() * std::cos(mark->angle) - along.x() * std::sin(mark->angle);
    return std::abs(sine) < std::sin(kOneLine);
  }

 private:
  struct Mark {
    int line = -1;    // -1: none
    int index = 0;    // of its point
    float angle = 0;  // radians

    [[nodiscard]] bool just_left(int by, int at) const {
      return line == by && std::abs(index - at) <= kOwn;
    }
  };

  BlockImage<Mark> marks_;
};

/// Follows one ridge after another; none twice.
class Follower {
 public:
  explicit Follower(const Channels& field)
      : surface_(field), marks_(field), most_(field.size().area()) {}

  /// The line through `seed`; fewer than two points where a line is there already.
  AxisLine follow(const RidgePoint& seed) {
    const Vector2f along(std::cos(seed.angle), std::sin(seed.angle));
    AxisLine line;
    ++line_;
    if (marks_.taken(seed.px, along, line_, 0)) return line;
    marks_.set(seed.px, along, reach_at(seed.px), line_, 0);
    const Points forwards = walk(seed.px, along, 1);
    line.closed = comes_back(forwards, seed.px, along);
    if (!line.closed) {
      const Points backwards = walk(seed.px, -along, -1);
      line.points_px.assign(backwards.rbegin(), backwards.rend());
    }
    line.points_px.push_back(seed.px);
    line.points_px.insert(line.points_px.end(), forwards.begin(), forwards.end());
    return line;
  }

 private:
  /// Whether a walk from `begin` ends there, and on the same ridge: a strand may cross its own.
  static bool comes_back(const Points& walked, const Vector2f& begin, const Vector2f& along) {
    if (walked.size() <= static_cast<std::size_t>(2 * kRope_px)) return false;
    const Vector2f heading = (walked.back() - walked[walked.size() - 2]).normalized();
    return (walked.back() - begin).norm() < kRope_px && heading.dot(along) > std::cos(kOneLine);
  }

  /// A pixel on along the ridge. False where it ends, or turns as no rope does.
  bool step(Vector2f& p, Vector2f& heading) const {
    p += heading;
    const Vector2f across(-heading.y(), heading.x());
    const float here = surface_.at(p, kCentre);
    const float left = surface_.at(p + across, kCentre);
    const float right = surface_.at(p - across, kCentre);
    const float bend = left + right - 2 * here;
    const float shift =
        bend < 0 ? 0.5F * (right - left) / bend : std::copysign(kMostShift_px, left - right);
    p += std::clamp(shift, -kMostShift_px, kMostShift_px) * across;
    const Surface::Spot spot = surface_.spot(p);
    if (spot.at(kCentre) < kFaint) return false;
    const auto along = Surface::direction(spot, heading);
    if (!along || along->dot(heading) < std::cos(kMostTurn)) return false;
    heading = *along;
    return true;
  }

  /// How far beside its axis a strand is still the same one: ridges of a wide one are many.
  [[nodiscard]] float reach_at(const Vector2f& p) const {
    const float width = kRope_px * std::exp2(std::clamp(surface_.at(p, kWidth), -1.0F, 2.0F));
    return std::max(kLeastReach_px, kStrandShare * width);
  }

  Points walk(Vector2f p, Vector2f heading, int sense) {
    Points points;
    for (int index = sense; std::abs(index) < most_; index += sense) {
      if (!step(p, heading) || marks_.taken(p, heading, line_, index)) break;
      points.push_back(p);
      marks_.set(p, heading, reach_at(p), line_, index);
    }
    return points;
  }

  Surface surface_;
  Marks marks_;
  int most_;
  int line_ = -1;
};

}  // namespace

std::vector<AxisLine> follow_ridges(const Channels& field) {
  std::vector<RidgePoint> seeds = ridges(field);
  std::stable_sort(seeds.begin(), seeds.end(), [](const RidgePoint& a, const RidgePoint& b) {
    return a.nearness > b.nearness;
  });
  Follower follower(field);
  std::vector<AxisLine> lines;
  for (const RidgePoint& seed : seeds) {
    AxisLine line = follower.follow(seed);
    if (static_cast<float>(line.points_px.size()) >= kLeastLength_px) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace flowdlo::field
