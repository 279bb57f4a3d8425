#include "strand/loss.hpp"

#include <span>
#include <vector>

#include "field/channel.hpp"

namespace flowdlo::strand {
namespace {

using torch::Tensor;

/// Binary cross-entropy, weighed by how wrong a pixel is: nearly all are sky.
Tensor focal(const Tensor& logit, const Tensor& target, const Tensor& weight) {
  const Tensor p = torch::sigmoid(logit);
  const Tensor each =
      torch::binary_cross_entropy_with_logits(logit, target, {}, {}, at::Reduction::None);
  return ((p - target).abs().detach() * each * weight).mean();
}

/// [kChannels] each [n, h, w]. Taken apart at once: a channel taken by itself has a gradient of
/// all.
using Channels = std::vector<Tensor>;

/// A doubled direction of any length: its channel and the next one.
struct Direction {
  Direction(const Channels& of, field::Channel first) : cos(of[first]), sin(of[first + 1]) {}
  Tensor cos;
  Tensor sin;
};

/// One less the cosine of the angle between two directions, summed where there is one. `target` is
/// of unit length.
Tensor apart(const Direction& output, const Direction& target, const Tensor& weight) {
  constexpr double kLeastSquare = 1e-8;
  const Tensor length =
      torch::sqrt(output.cos * output.cos + output.sin * output.sin + kLeastSquare);
  const Tensor along = (output.cos * target.cos + output.sin * target.sin) / length;
  return (weight * (1 - along)).sum();
}

/// Of the strand that shows and of the one below it. Crossings are a hundredth of a rope, and where
/// the two must be told apart: both weigh several times as much there. They share one norm, since a
/// sum over crossings alone would drown the direction of the strand that shows.
Tensor directions(const Channels& output, const Channels& target) {
  constexpr double kAtCrossings = 4;
  const Tensor& centre = target[field::kCentre];
  const Tensor& under = target[field::kUnder];
  const Tensor upper = apart({output, field::kCos}, {target, field::kCos},
                             centre.sqrt() * (1 + kAtCrossings * under));
  const Tensor lower =
      apart({output, field::kUnderCos}, {target, field::kUnderCos}, kAtCrossings * under.sqrt());
  return (upper + lower) / (centre.sum() + 1);
}

/// The largest of 9 x 9 pixels, [n, 1, h, w]: of each row's first.
Tensor largest_around(const Tensor& image) {
  constexpr int kReach = 4;
  const Tensor rows = torch::max_pool2d(image, {1, 2 * kReach + 1}, 1, {0, kReach});
  return torch::max_pool2d(rows, {2 * kReach + 1, 1}, 1, {kReach, 0});
}

}  // namespace

Tensor LossParts::total(const LossConfig& weights) const {
  Tensor sum = weights.centre * centre;
  for (const LossPart& part : std::span(kLossParts).subspan(1))
    sum = sum + weights.*part.weight * this->*part.value;
  return sum;
}

LossParts loss_of(const Tensor& output, const Tensor& target, const Tensor& planes) {
  const Channels out = output.unbind(1);
  const Channels want = target.unbind(1);
  const Tensor near = largest_around(planes.slice(1, field::kMask, field::kMask + 1)).squeeze(1);
  const Tensor& centre = want[field::kCentre];
  const Tensor& under = want[field::kUnder];
  const Tensor& rope = want[field::kRope];
  LossParts parts;
  parts.centre = focal(out[field::kCentre], centre, 0.3 + 1.2 * near + 4 * centre);
  parts.tip = focal(out[field::kTip], want[field::kTip], 0.5 + 0.5 * near + 10 * want[field::kTip]);
  parts.under = focal(out[field::kUnder], under, 0.3 + 0.7 * near + 6 * under);
  parts.rope = focal(out[field::kRope], rope, 0.3 + 0.7 * near);
  parts.edge =
      focal(out[field::kEdge], want[field::kEdge], 0.3 + 0.7 * near + 3 * want[field::kEdge]);
  parts.direction = directions(out, want);
  const Tensor off =
      torch::smooth_l1_loss(out[field::kWidth], want[field::kWidth], at::Reduction::None, 0.1);
  parts.width = (rope * off).sum() / (rope.sum() + 1);
  return parts;
}

}  // namespace flowdlo::strand
