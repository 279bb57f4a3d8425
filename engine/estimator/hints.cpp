#include "estimator/hints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "geometry/ring.hpp"

namespace flowdlo::estimator {
namespace {

constexpr std::size_t kMostEnds = 2;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kLevel = 1 - 1e-6;  // sums of distances nearer to each other are rounding
constexpr double kStill_m = 0.003;   // mean distance of a rope from where it was a frame before
constexpr double kMoved = 0.00025;   // probability that it is anywhere else
constexpr double kEndReach = 2;      // rope widths between a given end and the one that is meant
constexpr double kNoEnd = 0.0025;    // probability that none is
constexpr double kNoRing = 1e-6;     // probability that what is said to be a ring has two ends

/// The log of a density that falls off with a distance in units of its spread, beside one that is
/// the same everywhere and has a share of `elsewhere`; 0 at no distance, and as of an infinite one
/// where there is none.
double log_near(double distance, double elsewhere) {
  if (std::isnan(distance)) return std::log(elsewhere);
  return std::log(elsewhere + (1 - elsewhere) * std::exp(-0.5 * distance * distance));
}

bool fine(const Place& place, const Frame& frame) {
  if (const auto* point = std::get_if<Point3>(&place)) {
    return std::isfinite(point->x) && std::isfinite(point->y) && std::isfinite(point->z) &&
           point->z > 0;
  }
  const auto& pixel = std::get<Pixel>(place);
  const auto within = [](float at, int side) {
    const auto size = static_cast<float>(side);
    return at >= -size && at <= 2 * size;  // not of a NaN
  };
  return within(pixel.u, frame.width) && within(pixel.v, frame.height);
}

std::string fault_of(const std::string& name, const Place& place, const Frame& frame) {
  if (const auto* point = std::get_if<Point3>(&place)) {
    return fmt::format(
        "{}: expected a point in front of the camera, z > 0, got ({}, {}, {}); give "
        "metres of the camera frame",
        name, point->x, point->y, point->z);
  }
  const auto& pixel = std::get<Pixel>(place);
  return fmt::format(
      "{}: expected a pixel with u from {} to {} and v from {} to {}, got ({}, {}); "
      "give column and row in this frame",
      name, -frame.width, 2 * frame.width, -frame.height, 2 * frame.height, pixel.u, pixel.v);
}

/// Pixels, or metres to a point; infinite where the node cannot be seen.
double distance(const Point3& node, const Place& place, const Intrinsics& camera) {
  if (const auto* point = std::get_if<Point3>(&place)) return geometry::distance(node, *point);
  if (!(node.z > 0)) return kFar;
  const auto& pixel = std::get<Pixel>(place);
  const Eigen::Vector2f at = geometry::project(camera, node);
  return std::hypot(static_cast<double>(at.x() - pixel.u), static_cast<double>(at.y() - pixel.v));
}

/// In rope widths.
double widths(const Point3& node, const Place& place, const gate::Candidate& candidate,
              const Intrinsics& camera) {
  const double width_m = 2 * static_cast<double>(candidate.radius_m);
  const bool pixel = std::holds_alternative<Pixel>(place);
  const double unit = pixel ? width_m / static_cast<double>(candidate.pixel_m) : width_m;
  const double off = distance(node, place, camera) / std::max(unit, 1e-6);
  return std::isfinite(off) ? off : kFar;
}

/// Of its ends lying where `ends` are, each the other's, whichever way round suits them.
double log_of_ends(const gate::Candidate& candidate, const std::vector<Place>& ends,
                   const Intrinsics& camera) {
  const auto log_at = [&](std::size_t node, const Place& place) {
    return log_near(widths(candidate.nodes[node], place, candidate, camera) / kEndReach, kNoEnd);
  };
  double forward = log_at(0, ends.front());
  double backward = log_at(kNodes - 1, ends.front());
  if (ends.size() == kMostEnds) {
    forward += log_at(kNodes - 1, ends.back());
    backward += log_at(0, ends.back());
  }
  return std::max(forward, backward);
}

/// The sum over all nodes, metres, in that order.
double distance_in_order(const Centerline& nodes, const Centerline& previous, bool backwards) {
  double sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    sum += geometry::distance(nodes[backwards ? kNodes - 1 - i : i], previous[i]);
  }
  return sum;
}

bool to_be_turned(const Centerline& nodes, const Hints& hints, const Intrinsics& camera) {
  if (hints.first_end) {
    return distance(nodes.back(), *hints.first_end, camera) <
           distance(nodes.front(), *hints.first_end, camera);
  }
  if (!hints.previous) return false;
  return distance_in_order(nodes, *hints.previous, true) <
         kLevel * distance_in_order(nodes, *hints.previous, false);  // not of a NaN
}

/// A ring begins nowhere: it does where `previous` did, and runs that way round.
void begin_as(const Centerline& previous, Estimate& ring) {
  const auto told = geometry::told_like(ring.nodes, previous);
  const auto support = ring.support;
  const auto sigma_m = ring.sigma_m;
  ring.nodes = told.nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    ring.support[i] = support[told.from[i]];
    ring.sigma_m[i] = sigma_m[told.from[i]];
  }
  ring.reversed = told.reversed;
}

}  // namespace

Result<void> check(const Hints& hints, const Frame& frame) {
  std::string faults;
  const auto fault = [&](const std::string& line) {
    if (!faults.empty()) faults += '\n';
    faults += line;
  };
  if (hints.first_end && !fine(*hints.first_end, frame)) {
    fault(fault_of("Hints.first_end", *hints.first_end, frame));
  }
  if (hints.ends.size() > kMostEnds) {
    fault(fmt::format("Hints.ends: expected {} at most, got {}; a rope has no more", kMostEnds,
                      hints.ends.size()));
  }
  if (hints.closed == true && !hints.ends.empty()) {
    fault(
        fmt::format("Hints.ends: expected none of a rope that Hints.closed says is a ring, got {}",
                    hints.ends.size()));
  }
  for (std::size_t i = 0; i < std::min(hints.ends.size(), kMostEnds); ++i) {
    if (!fine(hints.ends[i], frame)) {
      fault(fault_of(fmt::format("Hints.ends[{}]", i), hints.ends[i], frame));
    }
  }
  if (hints.rope_length_m && !(std::isfinite(*hints.rope_length_m) && *hints.rope_length_m >= 0)) {
    fault(fmt::format("Hints.rope_length_m: expected metres, or 0 for unknown, got {}",
                      *hints.rope_length_m));
  }
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

std::vector<Eigen::Vector2f> end_directions(const Hints& hints, const Intrinsics& camera) {
  std::vector<Eigen::Vector2f> directions;
  for (const Place& place : hints.ends) {
    if (const auto* point = std::get_if<Point3>(&place)) {
      directions.emplace_back(point->x / point->z, point->y / point->z);
    } else {
      const auto& pixel = std::get<Pixel>(place);
      directions.emplace_back((pixel.u - camera.cx) / camera.fx, (pixel.v - camera.cy) / camera.fy);
    }
  }
  return directions;
}

std::vector<double> log_priors(const std::vector<gate::Candidate>& candidates, const Hints& hints,
                               const Intrinsics& camera) {
  const bool before = hints.previous && geometry::all_finite(*hints.previous);
  if (!before && hints.ends.empty() && hints.closed != true) return {};
  std::vector<double> logs;
  for (const gate::Candidate& candidate : candidates) {
    double log = 0;
    if (before) {
      const double moved_m =
          geometry::mean_distance(candidate.nodes, *hints.previous, candidate.ring > 0);
      log += log_near(moved_m / kStill_m, kMoved);
    }
    if (!hints.ends.empty()) log += log_of_ends(candidate, hints.ends, camera);
    if (hints.closed == true && candidate.ring == 0) log += std::log(kNoRing);
    logs.push_back(log);
  }
  return logs;
}

void turn(Estimate& estimate, const Hints& hints, const Intrinsics& camera) {
  if (estimate.closed && hints.previous && geometry::all_finite(*hints.previous)) {
    begin_as(*hints.previous, estimate);
  }
  if (to_be_turned(estimate.nodes, hints, camera)) {
    std::reverse(estimate.nodes.begin(), estimate.nodes.end());
    std::reverse(estimate.support.begin(), estimate.support.end());
    std::reverse(estimate.sigma_m.begin(), estimate.sigma_m.end());
    estimate.reversed = true;
  }
  for (Alternative& other : estimate.alternatives) {
    if (to_be_turned(other.nodes, hints, camera)) {
      std::reverse(other.nodes.begin(), other.nodes.end());
    }
  }
}

}  // namespace flowdlo::estimator
