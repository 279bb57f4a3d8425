#include "train/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "flow/gaussian_source.hpp"
#include "prior/prior.hpp"
#include "survey/table.hpp"
#include "survey/values.hpp"
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
  survey::Values prior;
  survey::Values model;
  survey::Values worse;
  GroupErrors result;
  for (const Errors& one : errors) {
    prior.add(one.prior_cm);
    model.add(one.model_cm);
    worse.add(one.model_cm > one.prior_cm + kHarm_cm ? 1 : 0);
    result.flips += one.flipped ? 1 : 0;
  }
  result.group = group;
  result.records = static_cast<int>(errors.size());
  result.prior_cm = prior.mean();
  result.model_cm = model.mean();
  result.prior_median_cm = prior.median();
  result.model_median_cm = model.median();
  result.prior_over = prior.percent_over(kOver_cm) / 100;
  result.model_over = model.percent_over(kOver_cm) / 100;
  result.harmed = worse.mean();
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
  survey::Table table({"group", "records", "prior cm", "model cm", "ratio", "median prior",
                       "median model", "prior > 2 cm", "model > 2 cm", "harmed", "flips"});
  for (const GroupErrors& g : groups) {
    std::vector<std::string> cells{g.group, std::to_string(g.records)};
    for (const double value :
         {g.prior_cm, g.model_cm, g.ratio(), g.prior_median_cm, g.model_median_cm}) {
      cells.push_back(fmt::format("{:.3f}", value));
    }
    for (const double share : {g.prior_over, g.model_over, g.harmed}) {
      cells.push_back(fmt::format("{:.1f} %", 100 * share));
    }
    cells.push_back(std::to_string(g.flips));
    table.add(std::move(cells));
  }
  return table.text();
}

}  // namespace flowdlo::train
