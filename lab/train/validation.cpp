#include "train/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "flow/gaussian_source.hpp"
#include "geometry/quantile.hpp"
#include "prior/prior.hpp"
#include "train/batch.hpp"

namespace flowdlo::train {
namespace {

using torch::Tensor;

constexpr double kOver_cm = 2;
constexpr double kHarm_cm = 0.1;
constexpr std::size_t kAtOnce = 32;

struct Errors {
  double prior_cm = 0;
  double model_cm = 0;
  bool flipped = false;
};

/// Mean distance over nodes [B, 64, 3] in cm: [B].
Tensor error_cm(const Tensor& nodes, const Tensor& truth, const Tensor& norm) {
  return (nodes - truth).norm(2, -1).mean(1) * norm.select(1, 3) * 100;  // Eq. (4.1)
}

GroupErrors summary(const std::string& group, const std::vector<Errors>& errors) {
  GroupErrors result;
  result.group = group;
  result.records = static_cast<int>(errors.size());
  std::vector<double> prior;
  std::vector<double> model;
  for (const Errors& one : errors) {
    prior.push_back(one.prior_cm);
    model.push_back(one.model_cm);
    result.prior_cm += one.prior_cm;
    result.model_cm += one.model_cm;
    result.prior_over += one.prior_cm > kOver_cm ? 1 : 0;
    result.model_over += one.model_cm > kOver_cm ? 1 : 0;
    result.harmed += one.model_cm > one.prior_cm + kHarm_cm ? 1 : 0;
    result.flips += one.flipped ? 1 : 0;
  }
  for (double* sum : {&result.prior_cm, &result.model_cm, &result.prior_over, &result.model_over,
                      &result.harmed}) {
    *sum /= result.records;
  }
  result.prior_median_cm = geometry::median_of(prior);
  result.model_median_cm = geometry::median_of(model);
  return result;
}

const char* name_of(Difficulty difficulty) {
  switch (difficulty) {
    case Difficulty::kEasy:
      return "easy";
    case Difficulty::kMiddle:
      return "middle";
    case Difficulty::kHard:
      break;
  }
  return "hard";
}

bool truth_flipped(const Record& record) {
  Centerline reversed = record.truth;
  std::reverse(reversed.begin(), reversed.end());
  const Centerline& prior = record.priors.front().nodes;
  return index_error(prior, reversed) < index_error(prior, record.truth);
}

}  // namespace

Tensor sample(VelocityModelImpl& model, std::span<const RecordView> views, const Tensor& source,
              int steps, torch::ScalarType compute, torch::Device device) {
  const torch::NoGradGuard no_gradients;
  const auto outer = model.node.scalar_type();
  const auto moved = [&](const Tensor& tensor) { return tensor.to(device, outer); };
  const auto batch = static_cast<std::int64_t>(views.size());
  ModelInput input = conditions_of(views);
  for (Tensor* part : {&input.prior, &input.support, &input.points, &input.valid}) {
    *part = moved(*part);
  }
  Tensor state = moved(source);
  for (int k = 0; k < steps; ++k) {
    const double t = static_cast<double>(k) / steps;  // Eq. (3.26)
    input.state = state;
    input.time = torch::full({batch}, t, state.options());
    input.features = moved(
        features_of(views, state.to(torch::kCPU, torch::kFloat32), model.variant.local_channels));
    const Tensor output = model.forward(input, compute);
    state = state + velocity(model.variant, output, state, input.time, input.prior) /
                        static_cast<double>(steps);  // Eq. (3.28)
  }
  return state.to(torch::kCPU);
}

std::vector<GroupErrors> validate_model(VelocityModelImpl& model, std::span<const Record> records,
                                        const ViewConfig& view, int steps,
                                        torch::ScalarType compute, torch::Device device) {
  ViewConfig fitting = view;
  fitting.truth_direction = TruthDirection::kPrior;
  const auto source = flow::gaussian_source(/*seed=*/0, /*draws=*/1);
  const Tensor one_draw = torch::tensor(source, torch::kFloat32).view({1, kNodes, 4});

  std::map<std::string, std::vector<Errors>> groups;
  for (std::size_t first = 0; first < records.size(); first += kAtOnce) {
    const auto some = records.subspan(first, std::min(kAtOnce, records.size() - first));
    std::vector<RecordView> views;
    views.reserve(some.size());
    for (const Record& record : some) views.emplace_back(record, 0, Turn{}, fitting);
    const auto batch = static_cast<std::int64_t>(views.size());
    const Tensor drawn = one_draw.narrow(2, 0, 3).expand({batch, kNodes, 3});
    const Tensor nodes = sample(model, views, drawn, steps, compute, device).to(torch::kFloat32);
    const Tensor truth = stacked(views, &RecordView::truth, 3);
    const Tensor norm = stacked(views, &RecordView::norm, 4).squeeze(1);
    const Tensor model_cm = error_cm(nodes, truth, norm);
    const Tensor prior_cm = error_cm(stacked(views, &RecordView::prior, 3), truth, norm);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto row = static_cast<std::int64_t>(i);
      const Errors errors{prior_cm[row].item<double>(), model_cm[row].item<double>(),
                          truth_flipped(some[i])};
      groups[" all"].push_back(errors);
      groups[std::string(" ") + name_of(some[i].difficulty)].push_back(errors);
      groups[some[i].scenario].push_back(errors);
    }
  }
  std::vector<GroupErrors> result;
  for (const auto& [name, errors] : groups) {
    result.push_back(summary(name.starts_with(' ') ? name.substr(1) : name, errors));
  }
  return result;
}

std::string table_of(const std::vector<GroupErrors>& groups) {
  std::string text =
      "| group | records | prior cm | model cm | ratio | median prior | median model | prior > 2 "
      "cm "
      "| model > 2 cm | harmed | flips |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const GroupErrors& group : groups) {
    text += fmt::format(
        "| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} % | {:.1f} % | {:.1f} % | "
        "{} |\n",
        group.group, group.records, group.prior_cm, group.model_cm, group.ratio(),
        group.prior_median_cm, group.model_median_cm, 100 * group.prior_over,
        100 * group.model_over, 100 * group.harmed, group.flips);
  }
  return text;
}

}  // namespace flowdlo::train
