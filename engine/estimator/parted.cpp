#include "estimator/parted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "flowdlo/config.hpp"
#include "geometry/depth.hpp"
#include "geometry/mask_box.hpp"
#include "geometry/pixel.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"
#include "geometry/segments.hpp"
#include "image/distance.hpp"
#include "image/line.hpp"
#include "image/masks.hpp"

namespace flowdlo::estimator {
namespace {

using Eigen::Vector2f;
using path::Path;
using path::RopePaths;

constexpr int kSpeckPixels = 12;         // a label below this is no rope
constexpr std::size_t kChordPoints = 4;  // of a path, for finding where two cross
constexpr float kFlattest = 0.3F;        // sine from which on a crossing gets no longer
constexpr float kZone = 0.75F;           // of both widths over the sine: how far a crossing reaches
constexpr float kBesideWidths = 2.0F;    // of a rope beside a crossing, which tells its depth
constexpr float kStretchWidths = 8.0F;   // of a path around a crossing,
constexpr float kStretchStep = 0.125F;   // in steps of so many widths
constexpr float kMostWidth = 1.6F;       // a rope is at most so many times as wide as is usual

std::size_t index_of(const Frame& frame, const Vector2f& p) {
  const int u = std::clamp(geometry::nearest_px(p.x()), 0, frame.width - 1);
  const int v = std::clamp(geometry::nearest_px(p.y()), 0, frame.height - 1);
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
         static_cast<std::size_t>(u);
}

bool masked(const Frame& frame, std::size_t pixel) { return frame.mask[pixel] > 127; }

image::Point nearest(const Vector2f& p) {
  return {geometry::nearest_px(p.x()), geometry::nearest_px(p.y())};
}

// What holds the mask, a pixel beside it, and all paths: nothing outside matters to any distance.
image::Rect box_of(const std::vector<Path>& paths, const Frame& frame) {
  const image::Rect mask = geometry::mask_box(frame);
  int left = mask.x - 1;
  int top = mask.y - 1;
  int right = mask.x + mask.width;
  int bottom = mask.y + mask.height;
  for (const Path& path : paths) {
    for (const Vector2f& p : path.points_px) {
      const image::Point at = nearest(p);
      left = std::min(left, at.x);
      top = std::min(top, at.y);
      right = std::max(right, at.x);
      bottom = std::max(bottom, at.y);
    }
  }
  return image::Rect{left, top, right - left + 1, bottom - top + 1} &
         image::Rect{0, 0, frame.width, frame.height};
}

// How far each pixel of the box is from the path.
image::Image<float> distance_to(const Path& path, const image::Rect& box) {
  image::Mask away(box.size(), 255);
  std::vector<image::Point> points;
  for (const Vector2f& p : path.points_px) points.push_back(nearest(p) - box.corner());
  image::draw_polyline(away, points, 0);
  return image::distance_to_empty(away);
}

// How wide the mask is along the path in the median; `inside` is how far each pixel of the box is
// from where the mask ends.
float width_along(const Path& path, const image::Image<float>& inside, const image::Rect& box,
                  float usual_px) {
  std::vector<float> widths;
  for (std::size_t i = 0; i < path.points_px.size(); ++i) {
    const image::Point at = nearest(path.points_px[i]) - box.corner();
    const int u = std::clamp(at.x, 0, inside.width() - 1);
    const int v = std::clamp(at.y, 0, inside.height() - 1);
    const float distance = inside.at(v, u);
    if (path.bridged[i] == 0 && distance > 0) widths.push_back(2 * distance - 0.5F);
  }
  if (widths.empty()) return usual_px;
  return std::clamp(geometry::median_of(widths), 1.0F, kMostWidth * usual_px);
}

// Where two paths cross: samples of either.
struct Meeting {
  std::array<std::size_t, 2> sample{};
  float sine = 1;
};

std::vector<Meeting> meetings(const Path& a, const Path& b) {
  std::vector<Meeting> result;
  const auto chord = [](const Path& path, std::size_t i) {
    return Vector2f(path.points_px[std::min(i + kChordPoints, path.points_px.size() - 1)] -
                    path.points_px[i]);
  };
  for (std::size_t i = 0; i + 1 < a.points_px.size(); i += kChordPoints) {
    const Vector2f d = chord(a, i);
    for (std::size_t j = 0; j + 1 < b.points_px.size(); j += kChordPoints) {
      const Vector2f between = b.points_px[j] - a.points_px[i];
      const Vector2f e = chord(b, j);
      if (between.squaredNorm() > 4 * (d.squaredNorm() + e.squaredNorm())) continue;
      if (!geometry::meeting(a.points_px[i], d, b.points_px[j], e)) continue;
      result.push_back({{i, j}, std::abs(geometry::cross(d, e)) / (d.norm() * e.norm())});
    }
  }
  return result;
}

// A path around one of its samples, for asking how far places are from it.
class Stretch {
 public:
  Stretch(const Path& path, std::size_t sample, float width_px) {
    const auto reach = static_cast<std::size_t>(kStretchWidths * width_px) + 1;
    const auto step = static_cast<std::size_t>(std::max(1.0F, kStretchStep * width_px));
    const std::size_t last = std::min(sample + reach, path.points_px.size() - 1);
    for (std::size_t i = sample > reach ? sample - reach : 0; i <= last; i += step) {
      points_.push_back(path.points_px[i]);
    }
  }

  [[nodiscard]] const std::vector<Vector2f>& points() const { return points_; }

  [[nodiscard]] float away_px(const Vector2f& p) const {
    float least = std::numeric_limits<float>::max();
    for (const Vector2f& q : points_) least = std::min(least, (p - q).squaredNorm());
    return std::sqrt(least);
  }

 private:
  std::vector<Vector2f> points_;
};

class Parting {
 public:
  Parting(const Frame& frame, Parted& parted)
      : frame_(frame), parted_(parted), box_(box_of(parted.paths.ropes, frame)) {
    const image::ConstMask given(frame.mask.data(), {frame.width, frame.height}, frame.width);
    const auto inside = image::distance_to_empty(image::above(given.part(box_), 127, 1));
    for (const Path& path : ropes()) {
      parted_.width_px.push_back(width_along(path, inside, box_, parted.paths.rope_width_px));
    }
  }

  // Each pixel of the mask to the path that it is nearest to, in widths of its rope; those of a
  // crossing to the upper one.
  void share_out() {
    parted_.instances.assign(frame_.mask.size(), 0);
    image::Image<float> least(box_.size(), std::numeric_limits<float>::max());
    for (std::size_t r = 0; r < ropes().size(); ++r) {
      const image::Image<float> distance = distance_to(ropes()[r], box_);
      for (int v = 0; v < box_.height; ++v) {
        const auto first =
            static_cast<std::size_t>(box_.y + v) * static_cast<std::size_t>(frame_.width) +
            static_cast<std::size_t>(box_.x);
        for (int u = 0; u < box_.width; ++u) {
          const std::size_t p = first + static_cast<std::size_t>(u);
          const float away = distance.at(v, u);
          if (!masked(frame_, p) || away >= least.at(v, u) * parted_.width_px[r]) continue;
          least.at(v, u) = away / parted_.width_px[r];
          parted_.instances[p] = static_cast<std::uint16_t>(r + 1);
        }
      }
    }
    for (std::size_t a = 0; a < ropes().size(); ++a) {
      for (std::size_t b = a + 1; b < ropes().size(); ++b) {
        for (const Meeting& meeting : meetings(ropes()[a], ropes()[b])) give(a, b, meeting);
      }
    }
  }

 private:
  [[nodiscard]] const std::vector<Path>& ropes() const { return parted_.paths.ropes; }

  // The depth of a rope beside where it meets another: of its first pixels to either side that
  // are not the other's; 0 where none are measured.
  [[nodiscard]] float depth_beside(std::size_t rope, std::size_t sample, const Stretch& other,
                                   float other_px) const {
    const Path& path = ropes()[rope];
    const auto count = static_cast<std::ptrdiff_t>(path.points_px.size());
    float sum = 0;
    float sides = 0;
    for (const std::ptrdiff_t step : {-1, 1}) {
      std::vector<float> depths;
      auto left = static_cast<int>(std::ceil(kBesideWidths * parted_.width_px[rope]));
      for (auto i = static_cast<std::ptrdiff_t>(sample); i >= 0 && i < count && left > 0;
           i += step) {
        const Vector2f& at = path.points_px[static_cast<std::size_t>(i)];
        if (other.away_px(at) < 0.5F * other_px + 1.5F) continue;
        const std::size_t pixel = index_of(frame_, at);
        --left;
        const float z = frame_.depth_m[pixel];
        if (masked(frame_, pixel) && geometry::measured(z)) depths.push_back(z);
      }
      if (depths.empty()) continue;
      sum += geometry::median_of(depths);
      ++sides;
    }
    return sides > 0 ? sum / sides : 0;
  }

  [[nodiscard]] bool bridged_at(std::size_t rope, std::size_t sample) const {
    const Path& path = ropes()[rope];
    const auto reach = static_cast<std::size_t>(parted_.width_px[rope]);
    const std::size_t first = sample > reach ? sample - reach : 0;
    const std::size_t last = std::min(sample + reach, path.bridged.size() - 1);
    return std::any_of(path.bridged.begin() + static_cast<std::ptrdiff_t>(first),
                       path.bridged.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                       [](std::uint8_t bridged) { return bridged != 0; });
  }

  // What a crossing of `a` and `b` shows goes to the upper one: whose mask is whole there, or else
  // which is nearer beside it.
  void give(std::size_t a, std::size_t b, const Meeting& meeting) {
    const Stretch near_a(ropes()[a], meeting.sample[0], parted_.width_px[a]);
    const Stretch near_b(ropes()[b], meeting.sample[1], parted_.width_px[b]);
    const float za = depth_beside(a, meeting.sample[0], near_b, parted_.width_px[b]);
    const float zb = depth_beside(b, meeting.sample[1], near_a, parted_.width_px[a]);
    bool first = za <= 0 || zb <= 0 || za <= zb;
    const bool bridges_a = bridged_at(a, meeting.sample[0]);
    if (bridges_a != bridged_at(b, meeting.sample[1])) first = !bridges_a;
    const std::size_t upper = first ? a : b;
    const Vector2f& at = ropes()[a].points_px[meeting.sample[0]];
    const float reach =
        kZone * (parted_.width_px[a] + parted_.width_px[b]) / std::max(kFlattest, meeting.sine);
    const float radius_px = 0.5F * parted_.width_px[upper] + 0.5F;
    for (const Vector2f& q : (first ? near_a : near_b).points()) {
      give_around(q, radius_px, at, reach, a, b, static_cast<std::uint16_t>(upper + 1));
    }
  }

  // What `a` and `b` have within `radius_px` of `q`, and within `reach` of `at`, is `now`'s.
  void give_around(const Vector2f& q, float radius_px, const Vector2f& at, float reach,
                   std::size_t a, std::size_t b, std::uint16_t now) {
    const Vector2f middle(static_cast<float>(geometry::nearest_px(at.x())),
                          static_cast<float>(geometry::nearest_px(at.y())));
    const Vector2f from = (q.array() - radius_px).max(middle.array() - reach).max(0.0F);
    const Vector2f to = (q.array() + radius_px).min(middle.array() + reach);
    const int last_u = std::min(static_cast<int>(to.x()), frame_.width - 1);
    const int last_v = std::min(static_cast<int>(to.y()), frame_.height - 1);
    for (int v = static_cast<int>(std::ceil(from.y())); v <= last_v; ++v) {
      for (int u = static_cast<int>(std::ceil(from.x())); u <= last_u; ++u) {
        const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame_.width) +
                           static_cast<std::size_t>(u);
        std::uint16_t& instance = parted_.instances[pixel];
        if (instance != a + 1 && instance != b + 1) continue;
        const Vector2f p(static_cast<float>(u), static_cast<float>(v));
        if ((p - middle).squaredNorm() > reach * reach) continue;
        if ((p - q).squaredNorm() <= radius_px * radius_px) instance = now;
      }
    }
  }

  const Frame& frame_;
  Parted& parted_;
  image::Rect box_;  // outside of which there is neither mask nor path
};

// The labels that cover more than a speck of the mask, in ascending order.
std::vector<std::uint16_t> labels_of(const Frame& frame) {
  std::map<std::uint16_t, int> pixels;
  for (std::size_t p = 0; p < frame.mask.size(); ++p) {
    if (masked(frame, p) && frame.instances[p] != 0) ++pixels[frame.instances[p]];
  }
  std::vector<std::uint16_t> labels;
  for (const auto& [label, count] : pixels) {
    if (count >= kSpeckPixels) labels.push_back(label);
  }
  return labels;
}

// Each label's own part of the mask as one rope; every other label may hide it.
Result<Parted> part_labelled(const Frame& frame) {
  const auto labels = labels_of(frame);
  if (labels.empty() || labels.size() > static_cast<std::size_t>(kMostRopes)) {
    return Error{ErrorCode::kNoPath,
                 fmt::format("Frame.instances: expected 1 to {} labels on the mask, got {}; check "
                             "the segmentation",
                             kMostRopes, labels.size())};
  }
  Parted parted;
  parted.instances.assign(frame.mask.size(), 0);
  std::vector<std::uint8_t> mask(frame.mask.size());
  std::vector<std::uint16_t> others(frame.mask.size());
  std::optional<Error> first_fault;
  for (const std::uint16_t label : labels) {
    const auto number = static_cast<std::uint16_t>(parted.paths.ropes.size() + 1);
    for (std::size_t p = 0; p < mask.size(); ++p) {
      const bool own = frame.instances[p] == label;
      mask[p] = own && masked(frame, p) ? 255 : 0;
      others[p] = own ? 0 : frame.instances[p];
      if (mask[p] != 0) parted.instances[p] = number;
    }
    Frame one = frame;
    one.mask = mask;
    one.instances = others;
    auto traced = path::trace_ropes(one, 1);
    if (!traced) {  // a few pixels that a segmentation got wrong cost no other rope
      if (traced.error().code == ErrorCode::kOutOfMemory) return traced.error();
      if (!first_fault) {
        first_fault = {traced.error().code,
                       fmt::format("Frame.instances, label {}: {}", label, traced.error().message)};
      }
      std::replace(parted.instances.begin(), parted.instances.end(), number, std::uint16_t{0});
      continue;
    }
    parted.width_px.push_back(traced->rope_width_px);
    parted.paths.rope_width_px = std::max(parted.paths.rope_width_px, traced->rope_width_px);
    parted.paths.ropes.push_back(std::move(traced->ropes.front()));
    parted.paths.lead.push_back(0);  // that of a mask of one rope tells nothing
    parted.witness.push_back(Witness::kLabel);
  }
  if (parted.paths.ropes.empty()) return *first_fault;
  return parted;
}

}  // namespace

Result<Parted> part_ropes(const Frame& frame, int ropes, const SeeAxes& see,
                          const std::vector<path::Path>& before) {
  if (!frame.instances.empty()) return part_labelled(frame);
  auto read = read_ropes(frame, ropes, see, before);
  if (!read) return read.error();
  Parted parted;
  parted.paths = std::move(read->paths);
  parted.witness = std::move(read->witness);
  parted.seen = std::move(read->seen);
  Parting(frame, parted).share_out();
  return parted;
}

std::vector<std::uint16_t> one_instance(const Frame& frame) {
  std::vector<std::uint16_t> instances(frame.mask.size(), 0);
  for (std::size_t p = 0; p < instances.size(); ++p) instances[p] = masked(frame, p) ? 1 : 0;
  return instances;
}

std::vector<std::uint16_t> sort_longest_first(std::vector<std::uint16_t> instances,
                                              std::vector<Estimate>& ropes) {
  std::vector<std::pair<float, std::size_t>> order;  // longest first, then as they were
  for (std::size_t i = 0; i < ropes.size(); ++i) {
    order.emplace_back(-geometry::length(ropes[i].nodes), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Estimate> sorted;
  std::vector<std::uint16_t> number(ropes.size() + 1, 0);
  for (const auto& [length, i] : order) {
    sorted.push_back(std::move(ropes[i]));
    number[i + 1] = static_cast<std::uint16_t>(sorted.size());
  }
  ropes = std::move(sorted);
  for (std::uint16_t& label : instances) label = number[label];
  return instances;
}

}  // namespace flowdlo::estimator
