#include "strand/patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "synth/drawn_frame.hpp"

namespace flowdlo::strand {
namespace {

constexpr double kStep_px = 0.5;
constexpr double kOwnSurface = 1.8;  // radii before its axis that a rope's own surface lies at most
constexpr double kNearWidths = 2.5;  // between axes of strands that are near each other
constexpr double kApartWidths = 4;   // of arclength between two strands
constexpr float kHeldWidths = 8;     // of a rope's end, hidden by what holds it, as of a gripper

using synth::Vector2d;
using synth::Vector3d;

Vector2d project(const Intrinsics& camera, const Vector3d& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

Seen seen(const synth::SyntheticFrame& frame, const AxisPoint& point, double radius_m) {
  const auto u = static_cast<int>(std::lround(point.u));
  const auto v = static_cast<int>(std::lround(point.v));
  if (u < 0 || v < 0 || u >= frame.folder.width || v >= frame.folder.height) return Seen::kNo;
  const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.folder.width) +
                     static_cast<std::size_t>(u);
  if (frame.dense->mask[pixel] == 0) return Seen::kNo;
  const double own = static_cast<double>(point.depth_m) - kOwnSurface * radius_m;
  return static_cast<double>(frame.dense->depth_m[pixel]) < own ? Seen::kUnder : Seen::kYes;
}

/// Samples so dense that they lie half a pixel apart.
Strand strand_of(const synth::SyntheticFrame& frame, std::size_t rope) {
  const Intrinsics& camera = frame.folder.intrinsics;
  const synth::Curve& curve = frame.dense->curves[rope];
  const double radius_m = frame.ropes[rope].radius_m;
  Strand strand;
  strand.rope = static_cast<int>(rope);
  strand.begins = strand.ends = !frame.ropes[rope].closed;
  const auto add = [&](const Vector3d& p, double along) {
    const Vector2d at = project(camera, p);
    AxisPoint point{static_cast<float>(at.x()),
                    static_cast<float>(at.y()),
                    static_cast<float>(radius_m * camera.fx / p.z()),
                    static_cast<float>(p.z()),
                    static_cast<float>(along / (2 * radius_m)),
                    Seen::kYes};
    point.seen = seen(frame, point, radius_m);
    strand.points.push_back(point);
  };
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    const Vector3d& a = curve.points[i];
    const Vector3d& b = curve.points[i + 1];
    const double px = (project(camera, b) - project(camera, a)).norm();
    const int pieces = std::max(1, static_cast<int>(std::ceil(px / kStep_px)));
    for (int k = 0; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      add((1 - t) * a + t * b, curve.step_m * (static_cast<double>(i) + t));
    }
  }
  add(curve.points.back(), curve.length_m());
  return strand;
}

/// How many points from `first` on are hidden by what holds the rope's end there: a few widths of
/// it, inside the image, behind no other strand.
template <class Iterator>
std::ptrdiff_t held(Iterator first, Iterator last, const FrameFolder& folder) {
  const auto shown =
      std::find_if(first, last, [](const AxisPoint& p) { return p.seen != Seen::kNo; });
  if (shown == last) return 0;
  const bool inside = std::all_of(first, shown, [&](const AxisPoint& p) {
    return p.u >= 0 && p.v >= 0 && p.u < static_cast<float>(folder.width) &&
           p.v < static_cast<float>(folder.height);
  });
  const float hidden = std::abs(shown->along_widths - first->along_widths);
  return inside && hidden <= kHeldWidths ? shown - first : 0;
}

/// A strand whose held ends are where they are seen last: there a rope ends for all who look.
Strand without_held(Strand strand, const FrameFolder& folder) {
  auto& points = strand.points;
  if (strand.ends) {
    points.erase(points.end() - held(points.rbegin(), points.rend(), folder), points.end());
  }
  if (strand.begins) {
    points.erase(points.begin(), points.begin() + held(points.begin(), points.end(), folder));
  }
  return strand;
}

using Middles = std::vector<const AxisPoint*>;

/// Visible points of which a strand of another rope, or one farther along, is near.
Middles near_others(const std::vector<Strand>& strands) {
  constexpr std::size_t kStride = 6;
  struct Place {
    const AxisPoint* point;
    int rope;
  };
  std::vector<Place> sparse;
  for (const Strand& strand : strands) {
    for (std::size_t i = 0; i < strand.points.size(); i += kStride) {
      sparse.push_back({&strand.points[i], strand.rope});
    }
  }
  Middles near;
  for (const auto& [a, rope] : sparse) {
    const bool has_other = std::any_of(sparse.begin(), sparse.end(), [&](const Place& other) {
      const AxisPoint* b = other.point;
      const double off =
          std::hypot(static_cast<double>(a->u - b->u), static_cast<double>(a->v - b->v));
      return off < kNearWidths * 2 * static_cast<double>(a->radius_px) &&
             (rope != other.rope ||
              std::abs(static_cast<double>(a->along_widths - b->along_widths)) > kApartWidths);
    });
    if (has_other && a->seen == Seen::kYes) near.push_back(a);
  }
  return near;
}

/// The last visible points before a strand goes behind what is no rope.
Middles before_others(const std::vector<Strand>& strands, const FrameFolder& folder) {
  const auto within = [&](const AxisPoint& p) {
    return p.u > 0 && p.v > 0 && p.u < static_cast<float>(folder.width - 1) &&
           p.v < static_cast<float>(folder.height - 1);
  };
  Middles found;
  for (const Strand& strand : strands) {
    for (std::size_t i = 1; i < strand.points.size(); ++i) {
      const AxisPoint& a = strand.points[i - 1];
      const AxisPoint& b = strand.points[i];
      if (a.seen == Seen::kYes && b.seen == Seen::kNo && within(b)) found.push_back(&a);
      if (b.seen == Seen::kYes && a.seen == Seen::kNo && within(a)) found.push_back(&b);
    }
  }
  return found;
}

class Cutter {
 public:
  Cutter(const PatchConfig& config, std::uint64_t seed, std::uint64_t index)
      : config_(config), random_(seed * 0x9E3779B97F4A7C15ULL + index) {}

  std::vector<synth::Window> choose(const synth::SyntheticFrame& frame) {
    strands_ = strands_of(frame);
    const Middles near = near_others(strands_);
    hidden_ = config_.hidden_share > 0 ? before_others(strands_, frame.folder) : Middles{};
    Middles visible;
    for (const Strand& strand : strands_) {
      for (const AxisPoint& point : strand.points) {
        if (point.seen == Seen::kYes) visible.push_back(&point);
      }
    }
    windows_.clear();
    middles_.clear();
    for (int k = 0; k < config_.each && !visible.empty(); ++k) {
      const AxisPoint& middle = choose(near, visible);
      const double width_px = 2 * static_cast<double>(middle.radius_px);
      const int half = std::max(config_.least_half_px,
                                static_cast<int>(std::lround(config_.half_widths * width_px)));
      const auto shifted = [&](float at) {
        return static_cast<int>(std::lround(static_cast<double>(at) + uniform(-0.3, 0.3) * half));
      };
      const int u = shifted(middle.u);
      const int v = shifted(middle.v);
      const synth::Window window{std::max(0, u - half), std::max(0, v - half),
                                 std::min(frame.folder.width, u + half),
                                 std::min(frame.folder.height, v + half)};
      if (window.right - window.left < 16 || window.bottom - window.top < 16) continue;
      windows_.push_back(window);
      middles_.push_back(width_px);
    }
    return windows_;
  }

  [[nodiscard]] std::vector<Patch> cut(const synth::SyntheticFrame& frame) const {
    std::vector<Patch> patches;
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      patches.push_back(cut(frame, windows_[i], middles_[i]));
    }
    return patches;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  const AxisPoint& any_of(const Middles& of) {
    return *of[std::uniform_int_distribution<std::size_t>(0, of.size() - 1)(random_)];
  }

  const AxisPoint& choose(const Middles& near, const Middles& visible) {
    const double share = uniform(0, 1);
    if (share < config_.near_share && !near.empty()) return any_of(near);
    if (share < config_.near_share + config_.end_share) {
      const Strand& strand = strands_[static_cast<std::size_t>(
          uniform(0, 1) * static_cast<double>(strands_.size()) * 0.999)];
      const AxisPoint& end = uniform(0, 1) < 0.5 ? strand.points.front() : strand.points.back();
      if (end.seen == Seen::kYes) return end;
    } else if (share < config_.near_share + config_.end_share + config_.hidden_share &&
               !hidden_.empty()) {
      return any_of(hidden_);
    }
    return any_of(visible);
  }

  [[nodiscard]] Patch cut(const synth::SyntheticFrame& frame, const synth::Window& window,
                          double width_px) const;

  const PatchConfig& config_;
  std::mt19937_64 random_;
  std::vector<Strand> strands_;
  Middles hidden_;
  std::vector<synth::Window> windows_;
  std::vector<double> middles_;  // widths there, frame pixels
};

/// The stretches of a strand that come near an image of that size, moved and scaled into it.
std::vector<Strand> inside(const Strand& strand, const synth::Window& window, float scale,
                           const cv::Size& size) {
  constexpr float kAround = 3;  // widths
  std::vector<Strand> stretches;
  bool open = false;
  for (std::size_t i = 0; i < strand.points.size(); ++i) {
    AxisPoint point = strand.points[i];
    point.u = (point.u - static_cast<float>(window.left) + 0.5F) * scale - 0.5F;
    point.v = (point.v - static_cast<float>(window.top) + 0.5F) * scale - 0.5F;
    point.radius_px *= scale;
    const float around = kAround * 2 * point.radius_px;
    const bool here = point.u > -around && point.v > -around &&
                      point.u < static_cast<float>(size.width) + around &&
                      point.v < static_cast<float>(size.height) + around;
    if (here && !open) {
      stretches.emplace_back();
      stretches.back().rope = strand.rope;
      stretches.back().begins = i == 0 && strand.begins;
    }
    open = here;
    if (!here) continue;
    stretches.back().points.push_back(point);
    stretches.back().ends = i + 1 == strand.points.size() && strand.ends;
  }
  return stretches;
}

template <class T>
std::vector<T> pixels(const cv::Mat& image) {
  const cv::Mat whole = image.isContinuous() ? image : image.clone();
  const auto* begin = whole.ptr<T>();
  return {begin, begin + whole.total() * static_cast<std::size_t>(whole.channels())};
}

Patch Cutter::cut(const synth::SyntheticFrame& frame, const synth::Window& window,
                  double width_px) const {
  const FrameFolder& folder = frame.folder;
  const cv::Size whole(folder.width, folder.height);
  const cv::Rect box(window.left, window.top, window.right - window.left,
                     window.bottom - window.top);
  const auto part = [&](int type, const void* data) {
    return cv::Mat(whole, type, const_cast<void*>(data))(box);
  };
  Patch patch;
  patch.frame_scale = static_cast<float>(std::min(1.0, config_.most_rope_px / width_px));
  const auto side = [&](int px) {
    return std::max(8, static_cast<int>(std::lround(static_cast<float>(px) * patch.frame_scale)));
  };
  const cv::Size size(side(box.width), side(box.height));
  patch.width = size.width;
  patch.height = size.height;
  patch.focal_px = folder.intrinsics.fx * patch.frame_scale;
  patch.rope_px = static_cast<float>(width_px) * patch.frame_scale;
  cv::Mat color;
  cv::Mat mask;
  cv::resize(part(CV_8UC3, folder.color_bgr.data()), color, size, 0, 0, cv::INTER_AREA);
  cv::resize(part(CV_8UC1, folder.mask.data()), mask, size, 0, 0, cv::INTER_AREA);
  patch.color_bgr = pixels<std::uint8_t>(color);
  patch.mask = pixels<std::uint8_t>(mask);
  const cv::Mat depth = part(CV_32FC1, folder.depth_m.data());
  cv::Mat known;
  cv::Mat share;
  cv::threshold(depth, known, 0, 1, cv::THRESH_BINARY);
  cv::resize(known, share, size, 0, 0, cv::INTER_AREA);
  cv::Mat mean;
  cv::resize(depth, mean, size, 0, 0, cv::INTER_AREA);
  patch.depth.resize(static_cast<std::size_t>(size.area()));
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const float by = share.at<float>(v, u);
      const double z = by > 0.5F ? static_cast<double>(mean.at<float>(v, u) / by) : 0.0;
      patch.depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(size.width) +
                  static_cast<std::size_t>(u)] =
          static_cast<std::uint16_t>(std::min(65535.0, std::round(z / synth::kDepthScale_m)));
    }
  }
  for (const Strand& strand : strands_) {
    for (Strand& stretch : inside(strand, window, patch.frame_scale, size)) {
      patch.strands.push_back(std::move(stretch));
    }
  }
  return patch;
}

}  // namespace

/// Of the kinds of several ropes all but those that the image ends before: their curves are known
/// inside it alone, and would show ends that are none.
synth::SyntheticFrame drawn_training_frame(std::uint64_t seed, std::uint64_t index) {
  constexpr std::array kSeveral{lab::RopesKind::kCrossing, lab::RopesKind::kColored,
                                lab::RopesKind::kHanging,  lab::RopesKind::kTouching,
                                lab::RopesKind::kRings,    lab::RopesKind::kGaps};
  const std::uint64_t number = index / 2;
  if (index % 2 == 0) {
    return synth::drawn_frame(static_cast<lab::Kind>(number % lab::kKinds),
                              synth::drawn_seed(synth::Part::kTraining, seed, number), true);
  }
  // Reports have the small seeds.
  const std::uint64_t ropes_seed = synth::drawn_seed(synth::Part::kTraining, seed + 1, number);
  return synth::drawn_ropes_frame(kSeveral[number % kSeveral.size()],
                                  2 + static_cast<int>(number / kSeveral.size() % 4), ropes_seed,
                                  true);
}

std::vector<Strand> whole_strands_of(const synth::SyntheticFrame& frame) {
  std::vector<Strand> strands;
  for (std::size_t k = 0; k < frame.dense->curves.size(); ++k) {
    strands.push_back(strand_of(frame, k));
  }
  return strands;
}

std::vector<Strand> strands_of(const synth::SyntheticFrame& frame) {
  std::vector<Strand> strands;
  for (Strand& strand : whole_strands_of(frame)) {
    strands.push_back(without_held(std::move(strand), frame.folder));
  }
  return strands;
}

Result<std::vector<Patch>> patches_of(synth::Split split, synth::Part part, std::uint64_t seed,
                                      std::uint64_t index, const PatchConfig& config,
                                      const synth::Render& as) {
  Cutter cutter(config, seed, index);
  synth::Render render = as;
  render.dense = true;
  render.windows = [&](const synth::SyntheticFrame& frame) { return cutter.choose(frame); };
  const auto frame = synth::make_frame(split, part, seed, index, render);
  if (!frame) return frame.error();
  return cutter.cut(*frame);
}

std::vector<Patch> drawn_patches_of(std::uint64_t seed, std::uint64_t index,
                                    const PatchConfig& config) {
  Cutter cutter(config, seed, index);
  const auto frame = drawn_training_frame(seed, index);
  cutter.choose(frame);
  return cutter.cut(frame);
}

}  // namespace flowdlo::strand
