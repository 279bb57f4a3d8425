#include "link_fit/labels.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "field/strand_field.hpp"
#include "geometry/quantile.hpp"
#include "path/path.hpp"
#include "path/strand_reading.hpp"
#include "strand/patch.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector2f;

constexpr float kBesideWidths = 0.5F;  // a strand's points lie so near the truth,
constexpr float kSameWay = 0.8F;       // cosine, and run along it,
constexpr float kLeastMatched = 0.6F;  // most of them

/// A rope's axis in pixels of the region, about one apart.
struct Truth {
  std::vector<Vector2f> line;
  std::vector<bool> inside;  ///< the image
  bool closed = false;
};

/// Where along the truth a strand lies, in its points; `last` < `first` where it runs backwards.
struct Stay {
  std::size_t rope = 0;
  int strand = 0;
  std::size_t matched = 0;  ///< of its points
  int first = 0;
  int last = 0;
  [[nodiscard]] int low() const { return std::min(first, last); }
  [[nodiscard]] int high() const { return std::max(first, last); }
  /// The strand's end at the truth's lower or higher side.
  [[nodiscard]] int end_at(bool higher) const {
    return 2 * strand + ((last > first) == higher ? 1 : 0);
  }
};

/// None where the strand does not lie on the truth.
std::optional<Stay> stay_of(const std::vector<Vector2f>& points, const std::vector<Vector2f>& truth,
                            float width_px) {
  std::vector<int> places;
  const auto count = static_cast<int>(points.size());
  const auto length = static_cast<int>(truth.size());
  for (int i = 0; i < count; ++i) {
    const Vector2f along =
        (points[std::min(i + 2, count - 1)] - points[std::max(i - 2, 0)]).normalized();
    float nearest = std::max(1.5F, kBesideWidths * width_px);
    int place = -1;
    for (int t = 0; t < length; ++t) {
      const float away = (truth[t] - points[i]).norm();
      if (away >= nearest) continue;
      const Vector2f way =
          (truth[std::min(t + 1, length - 1)] - truth[std::max(t - 1, 0)]).normalized();
      if (std::abs(way.dot(along)) < kSameWay) continue;
      nearest = away;
      place = t;
    }
    if (place >= 0) places.push_back(place);
  }
  if (static_cast<float>(places.size()) < kLeastMatched * static_cast<float>(count)) return {};
  if (places.size() < 4) return {};
  const auto quarter = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, places.size() / 4));
  Stay stay;
  stay.matched = places.size();
  std::vector<int> begin(places.begin(), places.begin() + quarter);
  std::vector<int> end(places.end() - quarter, places.end());
  stay.first = geometry::median_of(begin);
  stay.last = geometry::median_of(end);
  if (stay.first == stay.last) return {};
  return stay;
}

std::vector<Truth> truths_of(const synth::SyntheticFrame& scene, const path::Region& region) {
  std::vector<Truth> truths;
  for (const auto& strand : strand::strands_of(scene)) {
    Truth& truth = truths.emplace_back();
    truth.closed = scene.ropes[truths.size() - 1].closed;
    for (std::size_t i = 0; i < strand.points.size(); i += 2) {  // half a pixel apart
      const auto& p = strand.points[i];
      truth.line.emplace_back(Vector2f(p.u, p.v) - path::offset_of(region));
      truth.inside.push_back(p.u >= 0 && p.v >= 0 &&
                             p.u <= static_cast<float>(scene.folder.width - 1) &&
                             p.v <= static_cast<float>(scene.folder.height - 1));
    }
  }
  return truths;
}

/// Where each strand lies on its rope, by rope and along it. Empty where two lie on one stretch of
/// a rope: which of them is right cannot be told.
std::vector<Stay> stays_of(const path::Strands& strands, const std::vector<Truth>& truths) {
  std::vector<Stay> stays;
  for (std::size_t s = 0; s < strands.list.size(); ++s) {
    if (strands.list[s].ring) continue;
    std::optional<Stay> best;
    for (std::size_t r = 0; r < truths.size(); ++r) {
      auto stay = stay_of(strands.list[s].points_px, truths[r].line, strands.width_px);
      if (!stay || (best && stay->matched <= best->matched)) continue;
      stay->rope = r;
      stay->strand = static_cast<int>(s);
      best = stay;
    }
    if (best) stays.push_back(*best);
  }
  std::sort(stays.begin(), stays.end(), [](const Stay& a, const Stay& b) {
    return a.rope != b.rope ? a.rope < b.rope : a.low() < b.low();
  });
  for (std::size_t i = 1; i < stays.size(); ++i) {
    if (stays[i].rope != stays[i - 1].rope) continue;
    const int shared = stays[i - 1].high() - stays[i].low();
    const int shorter =
        std::min(stays[i - 1].high() - stays[i - 1].low(), stays[i].high() - stays[i].low());
    if (shared > 0 && 2 * shared > shorter) return {};
  }
  return stays;
}

/// Joins both ends, where the rope lies inside the image between its points `from` and `to`; else
/// it comes back as another rope.
void join(int a, int b, const Truth& truth, int from, int to, std::vector<int>& partners) {
  const auto first = truth.inside.begin() + std::min(from, to);
  const auto last = truth.inside.begin() + std::max(from, to);
  if (std::find(first, last, false) != last) return;
  partners[static_cast<std::size_t>(a)] = b;
  partners[static_cast<std::size_t>(b)] = a;
}

std::vector<int> partners_of(const path::Strands& strands, const std::vector<Stay>& stays,
                             const std::vector<Truth>& truths) {
  std::vector<int> partners(2 * strands.list.size(), kUnknown);
  for (const Stay& stay : stays) {
    partners[static_cast<std::size_t>(stay.end_at(false))] = kStops;
    partners[static_cast<std::size_t>(stay.end_at(true))] = kStops;
  }
  for (std::size_t i = 0, first = 0; i < stays.size(); ++i) {
    const Truth& truth = truths[stays[i].rope];
    if (i > 0 && stays[i].rope == stays[i - 1].rope) {
      join(stays[i - 1].end_at(true), stays[i].end_at(false), truth, stays[i - 1].high(),
           stays[i].low(), partners);
    } else {
      first = i;
    }
    const bool last = i + 1 == stays.size() || stays[i + 1].rope != stays[i].rope;
    if (!last || !truth.closed) continue;
    const int a = stays[i].end_at(true);
    const int b = stays[first].end_at(false);
    partners[static_cast<std::size_t>(a)] = b;
    partners[static_cast<std::size_t>(b)] = a;
  }
  return partners;
}

/// What the mask's own paths say: how wide a rope is and, of several, where they go.
struct Masked {
  float rope_width_px = 0;
  std::vector<path::RopesGuess> guesses{};
};

Result<Masked> read_mask(const Frame& frame, bool several) {
  if (!several) {
    const auto paths = path::trace(frame, {});
    if (!paths) return paths.error();
    return Masked{paths->rope_width_px};
  }
  auto paths = path::trace_ropes(frame, 0);
  if (!paths) return paths.error();
  return Masked{paths->rope_width_px, std::move(paths->guesses)};
}

}  // namespace

bool has_ring(const synth::SyntheticFrame& scene) {
  return std::any_of(scene.ropes.begin(), scene.ropes.end(),
                     [](const synth::TrueRope& rope) { return rope.closed; });
}

Result<std::unique_ptr<const Labelled>> label(synth::SyntheticFrame scene, bool several,
                                              field::Network& network) {
  auto labelled = std::make_unique<Labelled>();
  labelled->scene = std::move(scene);
  labelled->frame = labelled->scene.frame();
  labelled->frame.instances = {};
  const Frame& frame = labelled->frame;
  const auto masked = read_mask(frame, several);
  if (!masked) return masked.error();
  const auto seen = field::see(frame, masked->rope_width_px, network, several);
  if (!seen) return seen.error();
  labelled->axes = field::axes(*seen);
  labelled->axes.links = nullptr;
  auto region = path::clean(frame, several ? 0 : 1);
  if (!region) return region.error();
  labelled->region = *std::move(region);
  labelled->strands = path::strands_of(frame, labelled->axes, labelled->region, several);
  labelled->opinion = path::opinion_on(labelled->strands, masked->guesses, labelled->region);
  const auto truths = truths_of(labelled->scene, labelled->region);
  const auto stays = stays_of(labelled->strands, truths);
  labelled->partners = partners_of(labelled->strands, stays, truths);
  return std::unique_ptr<const Labelled>(std::move(labelled));
}

}  // namespace flowdlo::lab
