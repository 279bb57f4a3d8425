#include "refining/trainer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "survey/table.hpp"
#include "survey/values.hpp"

namespace flowdlo::refining {
namespace {

namespace nn = torch::nn;
using torch::Tensor;

constexpr std::uint64_t kFolds = 5;  // one of which is held out
constexpr int kNoteEvery = 200;
constexpr int kSaid = 3;           // deep, aside and whether the node lies on the table
constexpr float kNotLaid = -2;     // of the last one, at first
constexpr double kMostScale = 20;  // radii
constexpr float kMostAside = 1;    // radii, in the mean over a rope's nodes
constexpr double kSmooth = 0.1;    // radii; below it the loss is a parabola

/// Runs of scenes, for shares of them come in turns.
bool held_out(const StripSample& sample) { return sample.truth.scene / kFolds % kFolds == 0; }

/// [kRefineInputs] where each column comes from in a mirrored strip.
Tensor mirrored_columns() {
  auto columns = torch::arange(weights::kRefineInputs, torch::kLong);
  for (int plane = 0; plane < refine::kAcrossPlanes; ++plane) {
    const int first = plane * refine::kAcross;
    columns.slice(0, first, first + refine::kAcross)
        .copy_(torch::arange(first + refine::kAcross - 1, first - 1, -1, torch::kLong));
  }
  return columns;
}

Tensor signs(std::initializer_list<int> turned) {
  auto result = torch::ones(weights::kRefineInputs);
  for (const int column : turned) result[column] = -1;
  return result;
}

/// Whether the hypothesis takes the rope's way. One that does may be decimetres off all the same,
/// where depths are wrong or missing, but not aside.
bool right_way(const StripTruth& truth, const Schedule& schedule) {
  float aside = 0;
  for (const float off : truth.aside) aside += std::abs(off) / kNodes;
  const auto index_mm = static_cast<double>(truth.index_mm);
  return index_mm <= schedule.most_index_mm ||
         (aside < kMostAside && index_mm <= schedule.most_deep_mm);
}

struct Batch {
  Tensor strips;    // [n, kStations, kRefineInputs]
  Tensor to_table;  // [n, kNodes] radii
  Tensor truth;     // [n, kNodes, 2]

  [[nodiscard]] Batch to(torch::Device device) const {
    return {strips.to(device), to_table.to(device), truth.to(device)};
  }
};

/// Seen in a mirror, from the other end, or both.
Batch varied(Batch batch, bool mirror, bool reverse) {
  static const Tensor columns = mirrored_columns();
  static const Tensor aside = torch::tensor({1.0F, -1.0F});
  if (mirror) {
    static const Tensor sign = signs({refine::kTurn, refine::kBendAside});
    batch.strips = batch.strips.index_select(2, columns) * sign;
    batch.truth = batch.truth * aside;
  }
  if (reverse) {
    static const Tensor sign =
        signs({refine::kTurn, refine::kSlope, refine::kBendAlong, refine::kBendAside});
    batch.strips = batch.strips.flip(1).index_select(2, columns) * sign;
    batch.truth = batch.truth.flip(1) * aside;
    batch.to_table = batch.to_table.flip(1);
  }
  return batch;
}

Batch batch_of(const std::vector<StripSample>& samples, const std::vector<std::size_t>& which) {
  const auto count = static_cast<std::int64_t>(which.size());
  Batch batch{torch::empty({count, refine::kStations, weights::kRefineInputs}),
              torch::empty({count, static_cast<std::int64_t>(kNodes)}),
              torch::empty({count, static_cast<std::int64_t>(kNodes), 2})};
  for (std::int64_t i = 0; i < count; ++i) {
    const StripSample& sample = samples[which[static_cast<std::size_t>(i)]];
    std::copy(sample.strip.values.begin(), sample.strip.values.end(),
              batch.strips[i].data_ptr<float>());
    std::copy(sample.to_table.begin(), sample.to_table.end(), batch.to_table[i].data_ptr<float>());
    float* to = batch.truth[i].data_ptr<float>();
    for (std::size_t node = 0; node < kNodes; ++node) {
      *to++ = sample.truth.deep[node];
      *to++ = sample.truth.aside[node];
    }
  }
  return batch;
}

/// [n, kNodes, 2] by how much nodes are moved, deep and aside.
Tensor moved(Network& network, const Batch& batch) {
  const Tensor said = network->forward(batch.strips);
  const Tensor deep = said.select(2, 0) + torch::sigmoid(said.select(2, 2)) * batch.to_table;
  return torch::stack({deep, said.select(2, 1)}, 2);
}

/// A scene counts by how far its nodes are off, so that none drowns the others. `harm` is what a
/// node costs beside that which is worse than before.
Tensor loss_of(const Tensor& said, const Tensor& truth, double harm) {
  const Tensor scale = (0.15 + truth.abs().mean(1, true)).clamp_max(kMostScale);
  const Tensor off = torch::sqrt((truth - said).square() + kSmooth * kSmooth);
  const Tensor before = torch::sqrt(truth.square() + kSmooth * kSmooth);
  return ((off + harm * torch::relu(off - before)) / scale).mean();
}

double rate_at(const Schedule& schedule, int step) {
  const double warm = std::min(1.0, (step + 1.0) / std::max(1, schedule.warmup_steps));
  const double fall = 0.5 * (1 + std::cos(std::numbers::pi * step / schedule.steps));
  return warm * (schedule.final_rate + (schedule.rate - schedule.final_rate) * fall);
}

void follow(Network& average, const Network& network, double decay) {
  const torch::NoGradGuard no_gradients;
  const auto from = network->named_parameters();
  for (auto& item : average->named_parameters()) {
    item.value().mul_(decay).add_(from[item.key()], 1 - decay);
  }
}

/// Of scenes, before and after, mm.
struct Errors {
  std::array<survey::Values, 2> deep, aside, index;
};

void add(const StripSample& sample, const Tensor& said, Errors& errors) {
  const auto values = said.accessor<float, 2>();
  const double mm = 1000 * static_cast<double>(sample.truth.radius_m);
  for (const std::size_t after : {0, 1}) {
    double deep_mm = 0, aside_mm = 0, index_mm = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const auto of = [&](float truth, int column) {
        const float moved = values[static_cast<std::int64_t>(i)][column];
        return mm * static_cast<double>(truth - static_cast<float>(after) * moved);
      };
      const double deep = of(sample.truth.deep[i], 0);
      const double aside = of(sample.truth.aside[i], 1);
      deep_mm += std::abs(deep) / kNodes;
      aside_mm += std::abs(aside) / kNodes;
      index_mm += std::hypot(deep, aside, mm * static_cast<double>(sample.truth.along[i])) / kNodes;
    }
    errors.deep[after].add(deep_mm);
    errors.aside[after].add(aside_mm);
    errors.index[after].add(index_mm);
  }
}

void add_row(const char* name, const Errors& errors, survey::Table& table) {
  if (errors.index[0].count() == 0) return;
  std::vector<std::string> cells{name, std::to_string(errors.index[0].count())};
  for (const auto* both : {&errors.deep, &errors.aside, &errors.index}) {
    cells.push_back(fmt::format("{:.2f}, {:.2f}", (*both)[0].mean(), (*both)[1].mean()));
  }
  cells.push_back(
      fmt::format("{:.2f}, {:.2f}", errors.index[0].median(), errors.index[1].median()));
  table.add(std::move(cells));
}

std::string table_of(Network& network, const std::vector<StripSample>& samples,
                     const Schedule& schedule) {
  const torch::NoGradGuard no_gradients;
  Errors of_model;
  Errors of_matched;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const StripSample& sample = samples[i];
    if (!held_out(sample) || !right_way(sample.truth, schedule)) continue;
    const Tensor said = moved(network, batch_of(samples, {i}))[0].contiguous();
    add(sample, said, sample.truth.matched > 0 ? of_matched : of_model);
  }
  survey::Table table({"depth", "held-out scenes", "deep, mm, before and after", "aside",
                       "index error", "median index error"});
  add_row("model of the noise", of_model, table);
  add_row("matched", of_matched, table);
  return table.text();
}

weights::Tensor laid_out(const std::string& name, const Tensor& weight, int rows) {
  const Tensor taps = weight.detach().flatten(2).permute({0, 2, 1}).contiguous();
  Tensor padded = torch::zeros({rows, taps.size(1), taps.size(2)});
  padded.slice(0, 0, taps.size(0)).copy_(taps);
  const float* const values = padded.data_ptr<float>();
  return {name,
          {rows, static_cast<int>(taps.size(1)), static_cast<int>(taps.size(2))},
          {values, values + padded.numel()}};
}

}  // namespace

NetworkImpl::NetworkImpl() {
  const auto convolution = [](int in, int out, int side) {
    return nn::Conv2d(nn::Conv2dOptions(in, out, side).padding(side / 2));
  };
  stem = register_module("stem", convolution(weights::kRefineInputs, weights::kRefineStem, 1));
  register_module("squares", squares);
  for (int i = 0; i < weights::kRefineSquares; ++i) {
    auto square = convolution(i == 0 ? weights::kRefineStem : weights::kRefineWidth,
                              weights::kRefineWidth, 3);
    nn::init::kaiming_normal_(square->weight, 0, torch::kFanIn, torch::kReLU);
    nn::init::zeros_(square->bias);
    squares->push_back(square);
  }
  head = register_module("head", convolution(weights::kRefineWidth, kSaid, 1));
  nn::init::zeros_(head->weight);
  nn::init::zeros_(head->bias);
  const torch::NoGradGuard no_gradients;
  head->bias[kSaid - 1] = kNotLaid;
}

Tensor NetworkImpl::forward(const Tensor& strips) {
  const auto count = strips.size(0);
  Tensor x = strips
                 .view({count, static_cast<std::int64_t>(kNodes), refine::kStationsOfNode,
                        weights::kRefineInputs})
                 .permute({0, 3, 2, 1});
  x = torch::relu(stem->forward(x));
  for (const auto& square : *squares) x = torch::relu(square->as<nn::Conv2d>()->forward(x));
  const Tensor said = head->forward(x).mean(2);  // [count, kSaid, kNodes]
  constexpr int kReach = weights::kRefineAlike;
  const Tensor laid = torch::avg_pool1d(said.slice(1, kSaid - 1, kSaid), 2 * kReach + 1, 1, kReach,
                                        /*ceil_mode=*/false, /*count_include_pad=*/false);
  return torch::cat({said.slice(1, 0, kSaid - 1), laid}, 1).transpose(1, 2);
}

weights::RefineWeights exported(const Network& network, const std::string& notes) {
  weights::RefineWeights result{notes, {}};
  const auto put = [&](const std::string& name, const nn::Conv2dImpl& layer, int rows) {
    result.tensors.push_back(laid_out("refine." + name + ".weight", layer.weight, rows));
    Tensor bias = torch::zeros({rows});
    bias.slice(0, 0, layer.bias.size(0)).copy_(layer.bias.detach());
    const float* const values = bias.data_ptr<float>();
    result.tensors.push_back({"refine." + name + ".bias", {rows}, {values, values + bias.numel()}});
  };
  put("stem", *network->stem, weights::kRefineStem);
  for (std::size_t i = 0; i < network->squares->size(); ++i) {
    put(fmt::format("square.{}", i), network->squares->at<nn::Conv2dImpl>(i),
        weights::kRefineWidth);
  }
  put("head", *network->head, weights::kRefineOutputs);
  return result;
}

Result<Trained> train(const Recipe& recipe, const std::vector<StripSample>& samples,
                      torch::Device device,
                      const std::function<void(const std::string&)>& on_note) {
  const Schedule& schedule = recipe.schedule;
  std::vector<std::size_t> which;
  std::vector<double> shares;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const StripTruth& truth = samples[i].truth;
    if (held_out(samples[i]) || !right_way(truth, schedule)) continue;
    which.push_back(i);
    shares.push_back(truth.matched > 0 ? schedule.matched_weight : 1);
  }
  constexpr std::size_t kLeast = 10;
  if (which.size() < kLeast) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("flowdlo-train refine: expected {} strips to train on at least, got "
                             "{}; raise data.scenes",
                             kLeast, which.size())};
  }
  torch::manual_seed(recipe.seed);
  std::mt19937_64 random(recipe.seed);
  std::discrete_distribution<std::size_t> draw(shares.begin(), shares.end());
  Network network;
  Network average;
  network->to(device);
  average->to(device);
  follow(average, network, 0);
  torch::optim::AdamW optimizer(network->parameters(), torch::optim::AdamWOptions(schedule.rate)
                                                           .weight_decay(schedule.weight_decay)
                                                           .betas({0.9, 0.98}));
  double total = 0;
  for (int step = 0; step < schedule.steps; ++step) {
    for (auto& group : optimizer.param_groups()) {
      static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate_at(schedule, step));
    }
    std::vector<std::size_t> drawn;
    for (int i = 0; i < schedule.batch; ++i) drawn.push_back(which[draw(random)]);
    const auto turns = random();
    const Batch batch =
        varied(batch_of(samples, drawn), (turns & 1U) != 0, (turns & 2U) != 0).to(device);
    const Tensor loss = loss_of(moved(network, batch), batch.truth, schedule.harm);
    const double value = loss.item<double>();
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInternal,
                   fmt::format("flowdlo-train refine: expected a finite loss, got {} at step {}; "
                               "lower schedule.rate",
                               value, step)};
    }
    optimizer.zero_grad();
    loss.backward();
    if (schedule.clip_norm > 0) {
      nn::utils::clip_grad_norm_(network->parameters(), schedule.clip_norm);
    }
    optimizer.step();
    follow(average, network, std::min(schedule.ema_decay, 1 - 1 / (0.1 * step + 2)));
    total += value;
    if ((step + 1) % kNoteEvery == 0 && on_note) {
      on_note(fmt::format("{}/{}  loss {:.4f}", step + 1, schedule.steps, total / kNoteEvery));
      total = 0;
    }
  }
  average->to(torch::kCPU);
  return Trained{average, table_of(average, samples, schedule)};
}

}  // namespace flowdlo::refining
