#include "path/second_opinion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "geometry/quantile.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr float kBesideWidths = 0.5F;  // a strand's points lie so near a path,
constexpr float kBesidePx = 1.5F;      // or so near,
constexpr float kSameWay = 0.8F;       // cosine, and run along it,
constexpr float kLeastShare = 0.6F;    // most of them
constexpr int kLooked = 60;            // points of a strand that are looked for
constexpr int kArm = 2;                // points to either side that tell a direction

// Where along a path a strand lies, in the path's points; `last` < `first` where it runs
// backwards.
struct Stay {
  int strand = 0;
  std::size_t matched = 0;  // points of the strand that lie there
  int first = 0;
  int last = 0;
  [[nodiscard]] int low() const { return std::min(first, last); }
  [[nodiscard]] int high() const { return std::max(first, last); }
  // The strand's end at the path's lower or higher side.
  [[nodiscard]] int end_at(bool higher) const {
    return 2 * strand + ((last > first) == higher ? 1 : 0);
  }
};

Vector2f along(const Points& points, int i) {
  const int last = static_cast<int>(points.size()) - 1;
  return (points[std::min(i + kArm, last)] - points[std::max(i - kArm, 0)]).normalized();
}

// The point of `line` that is nearest to `p`, within `reach_px`, and runs along `way`.
std::optional<int> nearest_along(const Points& line, const Vector2f& p, const Vector2f& way,
                                 float reach_px) {
  std::optional<int> nearest;
  const auto count = static_cast<int>(line.size());
  float least = reach_px;
  for (int i = 0; i < count; ++i) {
    const float away = (line[i] - p).norm();
    if (away >= least) {  // points are no more than two pixels apart
      i += static_cast<int>(std::max(0.0F, away - reach_px - 2) / 2);
      continue;
    }
    if (std::abs(along(line, i).dot(way)) < kSameWay) continue;
    least = away;
    nearest = i;
  }
  return nearest;
}

std::optional<Stay> stay_of(int strand, const Strands& strands, const Points& line) {
  const Strand& own = strands.list[strand];
  if (own.ring) return {};
  const float reach_px = std::max(kBesidePx, kBesideWidths * width_px_of(own, strands));
  const auto count = static_cast<int>(own.points_px.size());
  const int step = std::max(1, count / kLooked);
  std::vector<int> places;
  int looked = 0;
  for (int i = 0; i < count; i += step, ++looked) {
    const auto place = nearest_along(line, own.points_px[i], along(own.points_px, i), reach_px);
    if (place) places.push_back(*place);
  }
  if (places.empty()) return {};
  if (static_cast<float>(places.size()) < kLeastShare * static_cast<float>(looked)) return {};
  const auto quarter = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, places.size() / 4));
  std::vector<int> begin(places.begin(), places.begin() + quarter);
  std::vector<int> end(places.end() - quarter, places.end());
  const Stay stay{strand, places.size(), geometry::median_of(begin), geometry::median_of(end)};
  if (stay.first == stay.last) return {};
  return stay;
}

// Of two strands on one stretch of a path only the longer one counts.
std::vector<Stay> in_order(std::vector<Stay> stays) {
  std::sort(stays.begin(), stays.end(), [](const Stay& a, const Stay& b) {
    return std::pair(a.low(), a.strand) < std::pair(b.low(), b.strand);
  });
  std::vector<Stay> kept;
  for (const Stay& stay : stays) {
    const int length = stay.high() - stay.low();
    const int before = kept.empty() ? 0 : kept.back().high() - kept.back().low();
    if (!kept.empty() && 2 * (kept.back().high() - stay.low()) > std::min(length, before)) {
      if (length > before) kept.back() = stay;
    } else {
      kept.push_back(stay);
    }
  }
  return kept;
}

class Listener {
 public:
  Listener(const Strands& strands, const Region& region)
      : strands_(strands), offset_(offset_of(region)) {}

  // Each strand is on the path of the guess that most of it lies on.
  void hear(const RopesGuess& guess, Opinion& opinion) {
    std::vector<const Heard*> paths;
    for (const Path& path : guess.ropes) paths.push_back(&heard(path));
    std::vector<std::vector<Stay>> stays(paths.size());
    for (std::size_t s = 0; s < strands_.list.size(); ++s) {
      std::optional<std::size_t> best;
      for (std::size_t p = 0; p < paths.size(); ++p) {
        const auto& stay = paths[p]->stays[s];
        if (stay && (!best || stay->matched > paths[*best]->stays[s]->matched)) best = p;
      }
      if (best) stays[*best].push_back(*paths[*best]->stays[s]);
    }
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const std::vector<Stay> order = in_order(std::move(stays[p]));
      const std::size_t links = order.size() - (guess.ropes[p].closed ? 0 : 1);
      for (const Stay& stay : order) {
        for (const bool higher : {false, true}) opinion.known[stay.end_at(higher)] += guess.share;
      }
      for (std::size_t i = 0; !order.empty() && i < links; ++i) {
        const int from = order[i].end_at(true);
        const int to = order[(i + 1) % order.size()].end_at(false);
        opinion.goes_on[from] += guess.share;
        opinion.goes_on[to] += guess.share;
        opinion.joined[std::minmax(from, to)] += guess.share;
      }
    }
  }

 private:
  // A path that many guesses may have.
  struct Heard {
    const Path* path = nullptr;
    std::vector<std::optional<Stay>> stays;  // [strands]
  };

  const Heard& heard(const Path& path) {
    for (const Heard& known : known_) {
      if (known.path->points_px == path.points_px) return known;
    }
    Points line;
    for (const Vector2f& p : path.points_px) line.push_back(p - offset_);
    Heard& heard = known_.emplace_back();
    heard.path = &path;
    for (int s = 0; s < static_cast<int>(strands_.list.size()); ++s) {
      heard.stays.push_back(stay_of(s, strands_, line));
    }
    return heard;
  }

  const Strands& strands_;
  Vector2f offset_;
  std::deque<Heard> known_;
};

}  // namespace

float Opinion::against(int a, int b) const {
  if (known.empty()) return 0;
  const auto together = joined.find(std::minmax(a, b));
  const float share = together == joined.end() ? 0 : together->second;
  return std::max(0.0F, std::max(known[a], known[b]) - share);
}

Opinion opinion_on(const Strands& strands, const std::vector<RopesGuess>& guesses,
                   const Region& region) {
  if (guesses.empty()) return {};
  const std::size_t ends = 2 * strands.list.size();
  Opinion opinion{std::vector<float>(ends, 0), std::vector<float>(ends, 0), {}};
  Listener listener(strands, region);
  for (const RopesGuess& guess : guesses) listener.hear(guess, opinion);
  for (auto* shares : {&opinion.known, &opinion.goes_on}) {
    for (float& share : *shares) share = std::min(share, 1.0F);
  }
  return opinion;
}

}  // namespace flowdlo::path
