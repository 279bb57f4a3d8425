// flowdlo_energy_fit: the weights of the path's energy (engine/path/energy.hpp), from `wide` scenes
// with truth. At each end of a strand that lies on the rope, the end that the rope really goes on
// with, or that it stops there, is to be likelier than all other choices.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "estimator/conditions.hpp"
#include "field/axes.hpp"
#include "field/strand_field.hpp"
#include "flowdlo/centerline.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"
#include "path/links.hpp"
#include "path/midline.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "path/strand_reading.hpp"
#include "strand/patch.hpp"
#include "strand/scene_range.hpp"

namespace {

namespace field = flowdlo::field;
namespace path = flowdlo::path;
namespace synth = flowdlo::synth;
using Eigen::Vector2f;

constexpr std::size_t kTerms = path::LinkTerms{}.size() + path::StopTerms{}.size();
constexpr float kBesideWidths = 0.5F;  // a strand's points lie so near the truth,
constexpr float kSameWay = 0.8F;       // cosine, and run along it,
constexpr float kLeastMatched = 0.6F;  // most of them
constexpr std::size_t kMostStrands = 40;

using Option = std::array<double, kTerms>;

/// What may happen at one end of a strand; the first option is what does.
struct Choice {
  std::vector<Option> options;
};

struct Outcome {
  std::uint64_t index = 0;
  std::vector<Choice> choices;
};

/// Where along the truth a strand lies, in its points; `last` < `first` where it runs backwards.
struct Stay {
  int strand = 0;
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
  std::vector<int> begin(places.begin(), places.begin() + quarter);
  std::vector<int> end(places.end() - quarter, places.end());
  stay.first = flowdlo::geometry::median_of(begin);
  stay.last = flowdlo::geometry::median_of(end);
  if (stay.first == stay.last) return {};
  return stay;
}

Option link_option(const path::LinkTerms& terms) {
  Option option{};
  std::copy(terms.begin(), terms.end(), option.begin());
  return option;
}

Option stop_option(const path::StopTerms& terms) {
  Option option{};
  std::copy(terms.begin(), terms.end(), option.begin() + path::kLinkTerms);
  return option;
}

/// The truth in pixels of the region, about one apart.
std::vector<Vector2f> truth_in(const path::Region& region, const flowdlo::Frame& frame,
                               const flowdlo::Centerline& truth) {
  std::vector<Vector2f> nodes;
  for (const flowdlo::Point3& node : truth) {
    nodes.push_back(flowdlo::geometry::project(frame.intrinsics, node) - path::offset_of(region));
  }
  const float length = path::length_of(nodes);
  return flowdlo::geometry::resample(nodes, std::max(64, static_cast<int>(length)));
}

std::vector<Choice> choices_of(const path::Strands& strands, const path::Region& region,
                               const flowdlo::Frame& frame, const flowdlo::Centerline& truth) {
  std::vector<Choice> choices;
  if (strands.list.size() > kMostStrands) return choices;
  const auto line = truth_in(region, frame, truth);
  std::vector<Stay> stays;
  for (std::size_t s = 0; s < strands.list.size(); ++s) {
    if (strands.list[s].ring) continue;
    auto stay = stay_of(strands.list[s].points_px, line, strands.width_px);
    if (!stay) continue;
    stay->strand = static_cast<int>(s);
    stays.push_back(*stay);
  }
  std::sort(stays.begin(), stays.end(),
            [](const Stay& a, const Stay& b) { return a.low() < b.low(); });
  for (std::size_t i = 1; i < stays.size(); ++i) {  // two lines of one strand tell nothing
    const int shared = stays[i - 1].high() - stays[i].low();
    const int shorter =
        std::min(stays[i - 1].high() - stays[i - 1].low(), stays[i].high() - stays[i].low());
    if (shared > 0 && 2 * shared > shorter) return choices;
  }
  const path::Cover cover(region, frame, strands.width_px, strands.seen);
  for (std::size_t i = 0; i < stays.size(); ++i) {
    for (const bool higher : {false, true}) {
      const int end = stays[i].end_at(higher);
      const bool stops = higher ? i + 1 == stays.size() : i == 0;
      const int right = stops ? -1 : stays[higher ? i + 1 : i - 1].end_at(!higher);
      Choice choice;
      const Option stop = stop_option(path::stop_terms(strands.end(end)));
      if (stops) choice.options.push_back(stop);
      if (!stops) {
        choice.options.push_back(link_option(path::link_between(end, right, strands, cover).terms));
        choice.options.push_back(stop);
      }
      for (int other = 0; other < static_cast<int>(2 * strands.list.size()); ++other) {
        if (other / 2 == end / 2 || other == right || strands.list[other / 2].ring) continue;
        choice.options.push_back(link_option(path::link_between(end, other, strands, cover).terms));
      }
      if (choice.options.size() > 1) choices.push_back(std::move(choice));
    }
  }
  return choices;
}

flowdlo::Result<Outcome> measure(const std::string& part, std::uint64_t index,
                                 field::Network& network) {
  auto scene =
      synth::make_frame(synth::Split::kWide, *synth::part_of(part), 0, index, synth::Render{});
  if (!scene) return scene.error();
  const flowdlo::Frame frame = scene->frame();
  const auto paths = path::trace(frame, {});
  if (!paths) return paths.error();
  const auto seen = field::see(frame, paths->rope_width_px, network);
  if (!seen) return seen.error();
  const auto axes = field::axes(*seen);
  const auto region = path::clean(frame);
  if (!region) return region.error();
  return Outcome{
      index, choices_of(path::strands_of(frame, axes, *region), *region, frame, scene->truth())};
}

using Weights = Eigen::Matrix<double, kTerms, 1>;

Eigen::Map<const Weights> as_vector(const Option& option) {
  return Eigen::Map<const Weights>(option.data());
}

/// Shares of a choice's options, and how unlikely the right one is.
double shares_of(const Choice& choice, const Weights& weights, std::vector<double>& shares) {
  shares.clear();
  double least = 1e9;
  for (const Option& option : choice.options) {
    shares.push_back(as_vector(option).dot(weights));
    least = std::min(least, shares.back());
  }
  double sum = 0;
  for (double& share : shares) sum += share = std::exp(least - share);
  for (double& share : shares) share /= sum;
  return -std::log(std::max(shares.front(), 1e-12));
}

double loss_of(const std::vector<Choice>& choices, const Weights& weights, double ridge) {
  std::vector<double> shares;
  double loss = 0.5 * ridge * weights.squaredNorm();
  for (const Choice& choice : choices) loss += shares_of(choice, weights, shares);
  return loss;
}

/// Newton's method; `free` says which weights move, the others stay 0.
Weights fitted(const std::vector<Choice>& choices, double ridge,
               const std::array<bool, kTerms>& free) {
  Weights weights = Weights::Zero();
  double loss = loss_of(choices, weights, ridge);
  std::vector<double> shares;
  for (int round = 0; round < 60; ++round) {
    Weights gradient = ridge * weights;
    Eigen::Matrix<double, kTerms, kTerms> hessian =
        ridge * Eigen::Matrix<double, kTerms, kTerms>::Identity();
    for (const Choice& choice : choices) {
      shares_of(choice, weights, shares);
      Weights mean = Weights::Zero();
      for (std::size_t i = 0; i < shares.size(); ++i)
        mean += shares[i] * as_vector(choice.options[i]);
      gradient += as_vector(choice.options[0]) - mean;
      for (std::size_t i = 0; i < shares.size(); ++i) {
        const Weights off = as_vector(choice.options[i]) - mean;
        hessian += shares[i] * off * off.transpose();
      }
    }
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (free[i]) continue;
      gradient[static_cast<Eigen::Index>(i)] = 0;
      hessian.row(static_cast<Eigen::Index>(i)).setZero();
      hessian.col(static_cast<Eigen::Index>(i)).setZero();
      hessian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 1;
    }
    const Weights step = hessian.ldlt().solve(gradient);
    double scale = 1;
    double next = 0;
    for (; scale > 1e-4; scale *= 0.5) {
      next = loss_of(choices, weights - scale * step, ridge);
      if (next < loss) break;
    }
    if (scale <= 1e-4 || loss - next < 1e-6 * loss) break;
    weights -= scale * step;
    loss = next;
  }
  return weights;
}

struct Quality {
  double unlikely = 0;  // mean negative logarithm of the right option's share
  double right = 0;     // share of choices whose right option is the likeliest
};

Quality quality_of(const std::vector<Choice>& choices, const Weights& weights) {
  Quality quality;
  std::vector<double> shares;
  for (const Choice& choice : choices) {
    quality.unlikely += shares_of(choice, weights, shares) / static_cast<double>(choices.size());
    const bool right = *std::max_element(shares.begin(), shares.end()) <= shares.front();
    quality.right += right ? 1.0 / static_cast<double>(choices.size()) : 0;
  }
  return quality;
}

const std::array<const char*, kTerms> kNames{
    "link: long", "bend", "bend of a stump", "open", "unshown", "stop: start", "unseen", "border"};

}  // namespace

int main(int argc, char** argv) {
  flowdlo::strand::SceneRange range;
  double ridge = 2;
  CLI::App app{"The weights of the path's energy, fitted to scenes with truth"};
  range.part = "training";
  flowdlo::strand::add_options(app, range);
  app.add_option("--ridge", ridge, "Half the weight of the weights' squares");
  CLI11_PARSE(app, argc, argv);
  const auto weights = flowdlo::strand::weights_of(range);
  if (!weights) return 1;
  const auto outcomes = flowdlo::strand::over_scenes<Outcome>(
      range, weights, [&](std::uint64_t index, field::Network& network) {
        return measure(range.part, index, network);
      });
  std::vector<Choice> fit;
  std::vector<Choice> held;
  for (const Outcome& outcome : outcomes) {
    auto& part = outcome.index % 4 == 0 ? held : fit;
    part.insert(part.end(), outcome.choices.begin(), outcome.choices.end());
  }
  std::array<bool, kTerms> free{};
  free.fill(true);
  const Weights all = fitted(fit, ridge, free);
  const Quality best = quality_of(held, all);
  Weights now = Weights::Zero();
  for (std::size_t i = 0; i < path::kLinkTerms; ++i)
    now[static_cast<Eigen::Index>(i)] = path::kLinkWeights[i];
  for (std::size_t i = 0; i < path::kStopTerms; ++i)
    now[static_cast<Eigen::Index>(path::kLinkTerms + i)] = path::kStopWeights[i];
  const Quality before = quality_of(held, now);
  fmt::print(
      "{} choices fitted, {} held out\nnow: {:.4f}, right {:.2f} %\nfitted: {:.4f}, right {:.2f} "
      "%\n",
      fit.size(), held.size(), before.unlikely, 100 * before.right, best.unlikely,
      100 * best.right);
  fmt::print("| term | weight | without it | right, % |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (!free[i]) continue;
    auto without = free;
    without[i] = false;
    const Quality quality = quality_of(held, fitted(fit, ridge, without));
    fmt::print("| {} | {:.3f} | {:+.4f} | {:.2f} |\n", kNames[i], all[static_cast<Eigen::Index>(i)],
               quality.unlikely - best.unlikely, 100 * quality.right);
  }
  return 0;
}
