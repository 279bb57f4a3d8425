#include "scene/ropes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/setting.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<std::string_view, kRopesKinds> kNames{
    "crossing", "colored", "hanging", "touching", "rings", "leaving", "gaps"};
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kFlattest = 0.42;     // sine of the flattest crossing
constexpr double kClear = 2.8;         // mean radii between ropes that do not cross
constexpr double kClearEnd = 6.0;      // radii between an end and a crossing
constexpr double kCrossingsApart = 7;  // radii between two crossings
constexpr double kSeparation = 0.97;   // of the sum of two radii, in space
constexpr int kPlacings = 60;          // of one rope
constexpr double kLeastInView = 0.35;  // of a rope's length
constexpr double kSwing_m = 0.01;      // of a hanging rope about its own distance

// A rope on the plane z = 0, which is seen from negative z.
struct Flat {
  Curve2 curve;  // evenly spaced
  double radius_m = 0;
  bool closed = false;
};

// Where two of them cross: indices of samples.
struct Meeting {
  std::array<std::size_t, 2> rope{};
  std::array<std::size_t, 2> sample{};
  double sine = 1;
  Vector2d at{0, 0};
};

double side(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double step_of(const Curve2& curve) { return (curve[1] - curve[0]).norm(); }

Curve2 moved(const Curve2& curve, double turn, const Vector2d& by) {
  Curve2 result;
  for (const Vector2d& p : curve) {
    result.emplace_back(p.x() * std::cos(turn) - p.y() * std::sin(turn) + by.x(),
                        p.x() * std::sin(turn) + p.y() * std::cos(turn) + by.y());
  }
  return result;
}

Curve2 evenly(const Curve2& curve, double spacing_m) {
  Curve3 lifted;
  for (const Vector2d& p : curve) lifted.emplace_back(p.x(), p.y(), 0);
  Curve2 result;
  for (const Vector3d& p : respaced(lifted, spacing_m)) result.emplace_back(p.x(), p.y());
  return result;
}

Curve2 ring(double radius_m, Random& random) {
  const double size = random.uniform(0.08, 0.16);
  const double flat = random.uniform(0, 0.2);
  const double dent = random.uniform(0, 0.08);
  const double phase = random.uniform(0, kTurn);
  Curve2 curve;
  for (int i = 0; i <= 720; ++i) {
    const double angle = kTurn * (i % 720) / 720;
    const double r = size * (1 + flat * std::cos(2 * angle) + dent * std::cos(3 * angle + phase));
    curve.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return evenly(curve, 0.5 * radius_m);
}

// A line beside a part of another rope, which it leaves on the same side at both ends.
std::optional<Curve2> beside(const Flat& other, double radius_m, Random& random) {
  const auto count = other.curve.size();
  const auto first =
      static_cast<std::size_t>(random.uniform(0.15, 0.4) * static_cast<double>(count));
  const auto last = static_cast<std::size_t>(random.uniform(0.5, 0.8) * static_cast<double>(count));
  const double apart = random.uniform(1.0, 1.06) * (other.radius_m + radius_m);
  const double hand = random.chance(0.5) ? 1 : -1;
  const auto place = [&](std::size_t i) -> std::pair<Vector2d, Vector2d> {
    const Vector2d along =
        (other.curve[std::min(i + 3, count - 1)] - other.curve[i < 3 ? 0 : i - 3]).normalized();
    const Vector2d normal(-hand * along.y(), hand * along.x());
    return {other.curve[i] + apart * normal, along};
  };
  const auto away = [&](const Vector2d& from, const Vector2d& along, double turns) {
    Curve2 arc;
    Vector2d p = from;
    double heading = std::atan2(along.y(), along.x());
    const double length = random.uniform(0.12, 0.3);
    const double curvature = turns * random.uniform(3.0, 7.0);
    for (double s = 0; s < length; s += 0.001) {
      heading += curvature * 0.001 * std::min(1.0, 3 - 3 * s / length);
      p += 0.001 * Vector2d(std::cos(heading), std::sin(heading));
      arc.push_back(p);
    }
    return arc;
  };
  Curve2 curve;
  const auto [start, back] = place(first);
  for (const Vector2d& p : away(start, -back, -hand)) curve.push_back(p);
  std::reverse(curve.begin(), curve.end());
  for (std::size_t i = first; i <= last; ++i) curve.push_back(place(i).first);
  const auto [end, on] = place(last);
  for (const Vector2d& p : away(end, on, hand)) curve.push_back(p);
  return evenly(curve, 0.5 * radius_m);
}

std::vector<Meeting> meetings(const std::vector<Flat>& ropes, std::size_t a, std::size_t b) {
  std::vector<Meeting> result;
  constexpr std::size_t kStride = 2;
  const Curve2& one = ropes[a].curve;
  const Curve2& two = ropes[b].curve;
  for (std::size_t i = 0; i + kStride < one.size(); i += kStride) {
    const Vector2d d = one[i + kStride] - one[i];
    for (std::size_t j = a == b ? i + 2 * kStride : 0; j + kStride < two.size(); j += kStride) {
      const Vector2d between = two[j] - one[i];
      const Vector2d e = two[j + kStride] - two[j];
      if (between.norm() > d.norm() + e.norm()) continue;
      const double cross = side(d, e);
      if (std::abs(cross) < 1e-15) continue;
      const double t = side(between, e) / cross;
      const double s = side(between, d) / cross;
      if (t < 0 || t >= 1 || s < 0 || s >= 1) continue;
      if (a == b && ropes[a].closed && i == 0 && j + 2 * kStride >= two.size()) continue;
      result.push_back({{a, b}, {i, j}, std::abs(cross) / (d.norm() * e.norm()), one[i] + t * d});
    }
  }
  return result;
}

// Near each other at crossings only.
bool clear_of(const Flat& a, const Flat& b, const std::vector<Meeting>& met) {
  const double reach = kClear * 0.5 * (a.radius_m + b.radius_m);
  for (std::size_t i = 0; i < a.curve.size(); i += 3) {
    for (std::size_t j = 0; j < b.curve.size(); j += 3) {
      if ((a.curve[i] - b.curve[j]).squaredNorm() > reach * reach) continue;
      const bool known = std::any_of(met.begin(), met.end(), [&](const Meeting& m) {
        return (m.at - a.curve[i]).norm() < reach * (1.5 / m.sine + 1);
      });
      if (!known) return false;
    }
  }
  return true;
}

bool ends_clear(const Flat& rope, const std::vector<Meeting>& met) {
  if (rope.closed) return true;
  return std::all_of(met.begin(), met.end(), [&](const Meeting& m) {
    const double least = kClearEnd * rope.radius_m;
    return (m.at - rope.curve.front()).norm() > least && (m.at - rope.curve.back()).norm() > least;
  });
}

class Maker {
 public:
  Maker(RopesKind kind, int wanted, Random& random)
      : kind_(kind), wanted_(static_cast<std::size_t>(wanted)), random_(random) {}

  std::optional<RopesScene> run() {
    if (!lay_all()) return std::nullopt;
    RopesScene scene;
    choose_camera(random_, scene.image);
    std::vector<Body> bodies = raise_all();
    if (!apart(bodies)) return std::nullopt;
    Plane plane;
    if (!place(bodies, plane, scene.image)) return std::nullopt;
    render(bodies, plane, scene.image);
    if (!note_seen(bodies, scene)) return std::nullopt;
    if (kind_ == RopesKind::kGaps) part_masks(random_.integer(1, 3), scene.image);
    measure(scene.image, false, random_);
    return scene;
  }

 private:
  // Flat ropes, each crossing what is there already at least once where it can.
  bool lay_all() {
    const double usual_m = random_.uniform(0.003, 0.006);
    for (std::size_t i = 0; i < wanted_; ++i) {
      bool laid = false;
      for (int k = 0; k < kPlacings && !laid; ++k) laid = lay(i, usual_m);
      if (!laid) return false;
    }
    return true;
  }

  bool lay(std::size_t index, double usual_m) {
    Flat rope;
    const bool own = kind_ == RopesKind::kColored;
    rope.radius_m = usual_m * (own ? random_.uniform(0.75, 1.35) : 1.0);
    const bool along = kind_ == RopesKind::kTouching && index == 1;
    rope.closed = kind_ == RopesKind::kRings && index == 0;
    if (rope.closed) {
      rope.curve = ring(rope.radius_m, random_);
    } else if (along) {
      auto curve = beside(flats_.front(), rope.radius_m, random_);
      if (!curve) return false;
      rope.curve = *std::move(curve);
    } else {
      Shape shape;
      shape.length_m = random_.uniform(0.4, 0.9);
      shape.radius_m = rope.radius_m;
      shape.wander = random_.uniform(0.05, 0.5);
      shape.most_crossings = random_.chance(0.25) ? 1 : 0;
      if (shape.most_crossings > 0) shape.wander = 0.8;
      const auto curve = wandering(shape, random_);
      if (!curve) return false;
      const double spread = index == 0 ? 0 : 0.12 + 0.02 * static_cast<double>(wanted_);
      rope.curve = moved(*curve, random_.uniform(0, kTurn),
                         {random_.uniform(-1.3, 1.3) * spread, random_.uniform(-1, 1) * spread});
    }
    flats_.push_back(std::move(rope));
    if (fits(along)) return true;
    flats_.pop_back();
    return false;
  }

  // Of the last rope: steep crossings, away from its ends and from others, and one at least.
  bool fits(bool along) {
    const std::size_t index = flats_.size() - 1;
    const Flat& rope = flats_.back();
    std::vector<Meeting> found = meetings(flats_, index, index);
    std::size_t crossed = 0;
    for (std::size_t other = 0; other < index; ++other) {
      const auto met = meetings(flats_, other, index);
      crossed += met.size();
      if (!ends_clear(flats_[other], met) || !ends_clear(rope, met)) return false;
      const bool touches = along && other == 0;
      if (touches && !met.empty()) return false;
      if (!touches && !clear_of(flats_[other], rope, met)) return false;
      found.insert(found.end(), met.begin(), met.end());
    }
    if (index > 0 && crossed == 0 && !along) return false;
    if (crossed > 4) return false;
    const bool steep = std::all_of(found.begin(), found.end(),
                                   [](const Meeting& m) { return m.sine > kFlattest; });
    if (!steep) return false;
    std::vector<Meeting> all = met_;
    for (const Meeting& m : found) {
      const bool near = std::any_of(all.begin(), all.end(), [&](const Meeting& other) {
        return (m.at - other.at).norm() < kCrossingsApart * (rope.radius_m + 0.001);
      });
      if (near) return false;
      all.push_back(m);
    }
    met_ = std::move(all);
    return true;
  }

  // At each crossing one passes over the other: on a table it climbs over it, in the air it is
  // nearer all along.
  std::vector<Body> raise_all() {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < flats_.size(); ++i) {
      Body body;
      body.radius_m = flats_[i].radius_m;
      if (kind_ == RopesKind::kColored) {
        body.color_rgb = {random_.uniform(40, 240), random_.uniform(40, 240),
                          random_.uniform(40, 240)};
      }
      const double nearer =
          kind_ == RopesKind::kHanging ? -0.06 * static_cast<double>(i) : -body.radius_m;
      const double phase = random_.uniform(0, kTurn);
      for (std::size_t k = 0; k < flats_[i].curve.size(); ++k) {
        const Vector2d& p = flats_[i].curve[k];
        const double t = static_cast<double>(k) / static_cast<double>(flats_[i].curve.size());
        const double swing =
            kind_ == RopesKind::kHanging ? kSwing_m * std::sin(kTurn * t + phase) : 0;
        body.curve.emplace_back(p.x(), p.y(), nearer + swing);
      }
      bodies.push_back(std::move(body));
    }
    for (const Meeting& m : met_) {
      if (kind_ == RopesKind::kHanging && m.rope[0] != m.rope[1]) continue;
      const std::size_t over = random_.chance(0.5) ? 0 : 1;
      climb(bodies, m, over);
    }
    return bodies;
  }

  void climb(std::vector<Body>& bodies, const Meeting& m, std::size_t over) {
    const Body& under = bodies[m.rope[1 - over]];
    Body& upper = bodies[m.rope[over]];
    const double height = 1.05 * (under.radius_m + upper.radius_m);
    const double below = under.curve[m.sample[1 - over]].z();
    const double half = upper.radius_m * (3 / m.sine + 7);
    const double step = step_of(flats_[m.rope[over]].curve);
    const auto count = static_cast<std::ptrdiff_t>(upper.curve.size());
    const auto reach = static_cast<std::ptrdiff_t>(half / step);
    const double rest = upper.curve[m.sample[over]].z();
    const double lift = std::max(0.0, rest - (below - height));
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      auto at = static_cast<std::ptrdiff_t>(m.sample[over]) + k;
      if (flats_[m.rope[over]].closed) at = (at % (count - 1) + count - 1) % (count - 1);
      if (at < 0 || at >= count) continue;
      const double share = 0.5 * (1 + std::cos(std::numbers::pi * static_cast<double>(k) /
                                               static_cast<double>(reach + 1)));
      upper.curve[static_cast<std::size_t>(at)].z() =
          std::min(upper.curve[static_cast<std::size_t>(at)].z(), rest - lift * share);
    }
    if (flats_[m.rope[over]].closed) upper.curve.back() = upper.curve.front();
  }

  // No rope runs through another.
  static bool apart(const std::vector<Body>& bodies) {
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      if (separation(bodies[a].curve, bodies[a].radius_m) < 1.9 * bodies[a].radius_m &&
          (bodies[a].curve.front() - bodies[a].curve.back()).norm() > 0) {
        return false;
      }
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        const double least = kSeparation * (bodies[a].radius_m + bodies[b].radius_m);
        for (const Vector3d& p : bodies[a].curve) {
          for (const Vector3d& q : bodies[b].curve) {
            if ((p - q).squaredNorm() < least * least) return false;
          }
        }
      }
    }
    return true;
  }

  // In front of the camera, so that they fill most of the image, or more than all of it.
  bool place(std::vector<Body>& bodies, Plane& plane, const Image& image) {
    const bool air = kind_ == RopesKind::kHanging;
    const double tilt = random_.uniform(-0.4, 0.4);
    Vector3d low = bodies.front().curve.front();
    Vector3d high = low;
    for (const Body& body : bodies) {
      for (const Vector3d& p : body.curve) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    const Vector3d middle(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), 0);
    double need = 0.3;
    for (Body& body : bodies) {
      for (Vector3d& p : body.curve) {
        p = turned_about_x(tilt) * (p - middle);
        need = std::max({need, std::abs(p.x()) * image.camera.fx / (0.46 * image.width) - p.z(),
                         std::abs(p.y()) * image.camera.fy / (0.46 * image.height) - p.z()});
      }
    }
    const bool leaves = kind_ == RopesKind::kLeaving;
    const double distance =
        std::max(0.3, need * (leaves ? random_.uniform(0.7, 0.9) : random_.uniform(1.02, 1.3)));
    for (Body& body : bodies) {
      for (Vector3d& p : body.curve) {
        p.z() += distance;
        if (p.z() < 0.2) return false;
      }
    }
    plane.normal = turned_about_x(tilt) * Vector3d(0, 0, 1);
    plane.offset_m = plane.normal.dot(Vector3d(0, 0, distance));
    if (air) plane = {Vector3d(0, 0, 1), distance + 1.2};
    return true;
  }

  // What the image shows of each rope: one stretch, long enough, and wide enough to be seen.
  bool note_seen(const std::vector<Body>& bodies, RopesScene& scene) {
    const Image& image = scene.image;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto& curve = bodies[i].curve;
      if (2 * bodies[i].radius_m * image.camera.fx / curve.front().z() < 4) return false;
      std::vector<std::pair<std::size_t, std::size_t>> stretches;
      for (std::size_t k = 0; k < curve.size(); ++k) {
        const Vector2d q = project(image.camera, curve[k]);
        const bool in =
            q.x() >= 0 && q.y() >= 0 && q.x() <= image.width - 1 && q.y() <= image.height - 1;
        if (!in) continue;
        if (!stretches.empty() && stretches.back().second == k) {
          stretches.back().second = k + 1;
        } else {
          stretches.emplace_back(k, k + 1);
        }
      }
      if (stretches.size() != 1) return false;
      const auto [first, last] = stretches.front();
      const auto shown = static_cast<double>(last - first);
      const bool whole = first == 0 && last == curve.size();
      if (shown < kLeastInView * static_cast<double>(curve.size())) return false;
      if (flats_[i].closed && !whole) return false;
      SeenRope seen;
      seen.curve = Curve3(curve.begin() + static_cast<std::ptrdiff_t>(first),
                          curve.begin() + static_cast<std::ptrdiff_t>(last));
      seen.truth = nodes_of(seen.curve);
      seen.radius_m = bodies[i].radius_m;
      seen.closed = flats_[i].closed;
      scene.ropes.push_back(std::move(seen));
    }
    return true;
  }

  // Where one rope's pixels lie within `gap_px` of a nearer rope's, the mask is empty.
  static void part_masks(int gap_px, Image& image) {
    const auto labels = image.instances;
    const auto depths = image.depth_m;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const std::size_t here = static_cast<std::size_t>(v) * image.width + u;
        if (labels[here] == 0) continue;
        for (int dv = -gap_px; dv <= gap_px; ++dv) {
          for (int du = -gap_px; du <= gap_px; ++du) {
            const int x = u + du;
            const int y = v + dv;
            if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
            const std::size_t there = static_cast<std::size_t>(y) * image.width + x;
            if (labels[there] == 0 || labels[there] == labels[here]) continue;
            if (depths[there] >= depths[here]) continue;
            image.mask[here] = 0;
            image.instances[here] = 0;
          }
        }
      }
    }
  }

  RopesKind kind_;
  std::size_t wanted_;
  Random& random_;
  std::vector<Flat> flats_;
  std::vector<Meeting> met_;
};

}  // namespace

std::string_view name_of(RopesKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<RopesKind> ropes_kind_of(std::string_view name) {
  for (int i = 0; i < kRopesKinds; ++i) {
    if (kNames[static_cast<std::size_t>(i)] == name) return static_cast<RopesKind>(i);
  }
  return std::nullopt;
}

RopesScene make_ropes(RopesKind kind, int ropes, std::uint64_t seed) {
  Random random((seed * 64 + static_cast<std::uint64_t>(ropes)) * kRopesKinds +
                static_cast<std::uint64_t>(kind));
  while (true) {
    if (auto scene = Maker(kind, ropes, random).run()) return *std::move(scene);
  }
}

}  // namespace flowdlo::lab
