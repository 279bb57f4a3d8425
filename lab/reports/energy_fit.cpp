// flowdlo-lab energy-fit: the weights of the path's energy (engine/path/energy.hpp), from scenes
// with truth. Each end of a strand might have gone on with another one, or stopped, and the ends
// that this frees would stop: what the rope really does is to be likelier than every such change.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command/report_commands.hpp"
#include "command_line.hpp"
#include "field/axes.hpp"
#include "field/strand_field.hpp"
#include "geometry/quantile.hpp"
#include "path/links.hpp"
#include "path/midline.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "path/strand_reading.hpp"
#include "strand/patch.hpp"
#include "strand/scene_range.hpp"
#include "survey/choice_fit.hpp"
#include "survey/table.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Vector2f;
using Eigen::VectorXd;

// Those of a link and of a stop. Where there is one rope,
// it has two ends whatever they cost: their start is a term of its own, which means nothing.
constexpr std::size_t kStartOfOne = path::LinkTerms{}.size() + path::StopTerms{}.size();
constexpr std::size_t kTerms = kStartOfOne + 1;
constexpr float kBesideWidths = 0.5F;  // a strand's points lie so near the truth,
constexpr float kSameWay = 0.8F;       // cosine, and run along it,
constexpr float kLeastMatched = 0.6F;  // most of them
constexpr std::size_t kMostStrands = 60;

/// The terms of what a change costs, beside what really happens.
using Option = std::array<double, kTerms>;

/// What may happen at the ends of a scene's strands; what does is the first option.
struct Outcome {
  std::uint64_t index = 0;
  std::vector<survey::Choice> choices;
};

/// A rope's axis in pixels of the region, about one apart.
struct Truth {
  std::vector<Vector2f> line;
  std::vector<bool> inside;  ///< the image
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

constexpr int kStops = -1;
constexpr int kUnknown = -2;  // a strand that lies on no rope is left out

/// [2 * strands] the end that the rope really goes on with from each.
std::vector<int> partners_of(const path::Strands& strands, const std::vector<Stay>& stays,
                             const std::vector<Truth>& truths) {
  std::vector<int> partners(2 * strands.list.size(), kUnknown);
  for (const Stay& stay : stays) {
    partners[static_cast<std::size_t>(stay.end_at(false))] = kStops;
    partners[static_cast<std::size_t>(stay.end_at(true))] = kStops;
  }
  for (std::size_t i = 1; i < stays.size(); ++i) {
    if (stays[i].rope != stays[i - 1].rope) continue;
    const auto& inside = truths[stays[i].rope].inside;
    const auto from = inside.begin() + std::min(stays[i - 1].high(), stays[i].low());
    const auto to = inside.begin() + std::max(stays[i - 1].high(), stays[i].low());
    if (std::find(from, to, false) != to) continue;  // it comes back as another rope
    const int a = stays[i - 1].end_at(true);
    const int b = stays[i].end_at(false);
    partners[static_cast<std::size_t>(a)] = b;
    partners[static_cast<std::size_t>(b)] = a;
  }
  return partners;
}

/// Options at the ends of strands.
class Changes {
 public:
  Changes(const path::Strands& strands, const path::Region& region, const Frame& frame,
          std::vector<int> partners, bool one_rope, const path::Opinion& opinion)
      : strands_(strands),
        cover_(region, frame, strands.width_px, strands.seen),
        partners_(std::move(partners)),
        one_rope_(one_rope),
        opinion_(opinion) {}

  std::vector<survey::Choice> all() const {
    std::vector<survey::Choice> choices;
    const auto ends = static_cast<int>(partners_.size());
    for (int end = 0; end < ends; ++end) {
      if (partner(end) == kUnknown) continue;
      std::vector<Option> options(1);
      if (partner(end) >= 0) options.push_back(freed(end));
      for (int other = 0; other < ends; ++other) {
        if (other == end || other == partner(end) || strands_.list[other / 2].ring) continue;
        if (other / 2 == end / 2 && one_rope_) continue;
        options.push_back(joined(end, other));
      }
      if (options.size() > 1) choices.push_back({rows_of(options)});
    }
    return choices;
  }

 private:
  static Eigen::MatrixXd rows_of(const std::vector<Option>& options) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(options.size()), kTerms);
    for (std::size_t i = 0; i < options.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) =
          -Eigen::Map<const Eigen::RowVectorXd>(options[i].data(), kTerms);  // costs are disliked
    }
    return rows;
  }
  [[nodiscard]] const path::LinkTerms& weights() const {
    return one_rope_ ? path::kOneRopeLinks : path::kSeveralRopesLinks;
  }
  [[nodiscard]] int partner(int end) const { return partners_[static_cast<std::size_t>(end)]; }

  void add_stop(int end, double sign, Option& option) const {
    const auto terms = path::stop_terms(strands_.end(end));
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const bool start = i == path::kStopStart && one_rope_;
      option[start ? kStartOfOne : path::kLinkTerms + i] += sign * static_cast<double>(terms[i]);
    }
  }
  void add_link(int from, int to, double sign, Option& option) const {
    constexpr float kAny = std::numeric_limits<float>::max();
    const float elsewhere = opinion_.against(from, to);
    const auto terms =
        path::link_between(from, to, strands_, cover_, weights(), kAny, elsewhere).terms;
    for (std::size_t i = 0; i < terms.size(); ++i)
      option[i] += sign * static_cast<double>(terms[i]);
  }

  /// `end` has lost what it had, and `lost` stops where it had something.
  void lose(int end, Option& option) const {
    const int had = partner(end);
    if (had == kStops) add_stop(end, -1, option);
    if (had < 0) return;
    add_link(end, had, -1, option);
    add_stop(had, 1, option);
  }

  [[nodiscard]] Option freed(int end) const {
    Option option{};
    lose(end, option);
    add_stop(end, 1, option);
    return option;
  }

  [[nodiscard]] Option joined(int end, int other) const {
    Option option{};
    lose(end, option);
    add_link(end, other, 1, option);
    if (partner(other) != kUnknown) {
      lose(other, option);
      return option;
    }
    add_stop(other ^ 1, 1, option);
    return option;
  }

  const path::Strands& strands_;
  path::Cover cover_;
  std::vector<int> partners_;
  bool one_rope_;
  const path::Opinion& opinion_;
};

/// What the mask's own paths say: how wide a rope is and, of several, where they go.
struct Masked {
  float rope_width_px = 0;
  std::vector<path::RopesGuess> guesses{};
};

Result<Masked> read_mask(const Frame& frame, bool one_rope) {
  if (one_rope) {
    const auto paths = path::trace(frame, {});
    if (!paths) return paths.error();
    return Masked{paths->rope_width_px};
  }
  auto paths = path::trace_ropes(frame, 0);
  if (!paths) return paths.error();
  return Masked{paths->rope_width_px, std::move(paths->guesses)};
}

Result<Outcome> measure(synth::Split split, const std::string& part, std::uint64_t index,
                        field::Network& network) {
  synth::Render render;
  render.dense = true;
  auto scene = synth::make_frame(split, *synth::part_of(part), 0, index, render);
  if (!scene) return scene.error();
  Frame frame = scene->frame();
  frame.instances = {};
  const bool one_rope = scene->ropes.size() == 1;
  Outcome outcome{index, {}};
  const bool ring = std::any_of(scene->ropes.begin(), scene->ropes.end(),
                                [](const synth::TrueRope& rope) { return rope.closed; });
  if (ring) return outcome;  // it begins nowhere
  const auto masked = read_mask(frame, one_rope);
  if (!masked) return masked.error();
  const auto seen = field::see(frame, masked->rope_width_px, network, !one_rope);
  if (!seen) return seen.error();
  const auto axes = field::axes(*seen);
  const auto region = path::clean(frame, one_rope ? 1 : 0);
  if (!region) return region.error();
  auto strands = path::strands_of(frame, axes, *region);
  const auto opinion = path::opinion_on(strands, masked->guesses, *region);
  path::heed(strands, opinion);
  if (strands.list.size() > kMostStrands) return outcome;
  const auto truths = truths_of(*scene, *region);
  const auto stays = stays_of(strands, truths);
  outcome.choices =
      Changes(strands, *region, frame, partners_of(strands, stays, truths), one_rope, opinion)
          .all();
  return outcome;
}

const std::array<const char*, kTerms> kNames{
    "link: long", "bend",      "bend of a stump", "open",   "unshown", "color",
    "depth",      "elsewhere", "stop: start",     "unseen", "goes on", "start of one"};

struct Options {
  strand::SceneRange range;
  std::uint64_t several = 0;
  double ridge = 2;
  std::string without;
};

/// As the engine has them; the start of one rope means nothing.
VectorXd compiled_weights() {
  VectorXd weights = VectorXd::Zero(kTerms);
  for (std::size_t i = 0; i < path::kLinkTerms; ++i) {
    weights[static_cast<Eigen::Index>(i)] = path::kSeveralRopesLinks[i];
  }
  for (std::size_t i = 0; i < path::kStopTerms; ++i) {
    weights[static_cast<Eigen::Index>(path::kLinkTerms + i)] = path::kStopWeights[i];
  }
  return weights;
}

void print(const Options& options, const std::vector<survey::Choice>& fitted,
           const std::vector<survey::Choice>& held) {
  std::vector<bool> fixed(kTerms);
  for (std::size_t i = 0; i < kTerms; ++i) {
    fixed[i] = ("," + options.without + ",").find(fmt::format(",{},", i)) != std::string::npos;
  }
  const VectorXd all = survey::fit(fitted, kTerms, options.ridge, fixed);
  const auto best = survey::quality_of(held, all);
  const auto before = survey::quality_of(held, compiled_weights());
  fmt::print(
      "{} choices fitted, {} held out\nnow: {:.4f}, right {:.2f} %\nfitted: {:.4f}, right {:.2f} "
      "%\n",
      fitted.size(), held.size(), before.unlikely, 100 * before.right, best.unlikely,
      100 * best.right);
  survey::Table table({"term", "weight", "without it", "right, %"});
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (fixed[i]) continue;
    auto others = fixed;
    others[i] = true;
    const auto quality =
        survey::quality_of(held, survey::fit(fitted, kTerms, options.ridge, others));
    table.add({kNames[i], fmt::format("{:.3f}", all[static_cast<Eigen::Index>(i)]),
               fmt::format("{:+.4f}", quality.unlikely - best.unlikely),
               fmt::format("{:.2f}", 100 * quality.right)});
  }
  fmt::print("{}", table.text());
}

int run(const Options& options) {
  auto range = options.range;
  std::vector<survey::Choice> fitted;
  std::vector<survey::Choice> held;
  for (const auto split : {synth::Split::kWide, synth::Split::kSeveral}) {
    if (split == synth::Split::kSeveral) range.scenes = options.several;
    const auto outcomes =
        strand::over_scenes<Outcome>(range, [&](std::uint64_t index, field::Network& network) {
          return measure(split, range.part, index, network);
        });
    for (const Outcome& outcome : outcomes) {
      auto& part = outcome.index % 4 == 0 ? held : fitted;
      part.insert(part.end(), outcome.choices.begin(), outcome.choices.end());
    }
  }
  if (fitted.empty()) return 1;
  print(options, fitted, held);
  return 0;
}

}  // namespace

void add_energy_fit(CLI::App& program, support::ExitCode& exit_code) {
  auto options = std::make_shared<Options>();
  auto& app = *support::add_command(
      program, "energy-fit", "The weights of the path's energy, fitted to scenes with truth");
  options->range.part = "training";
  strand::add_options(app, options->range);
  app.add_option("--several", options->several,
                 "So many scenes of several ropes as well, from the same on");
  app.add_option("--ridge", options->ridge, "Half the weight of the weights' squares");
  app.add_option("--without", options->without,
                 "Terms that are not used, by their numbers, as 5,8");
  support::set_action(app, exit_code, [options] { return run(*options); });
}

}  // namespace flowdlo::lab
