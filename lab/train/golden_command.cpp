// flowdlo-train golden: what libtorch says in double precision, for tests without it.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>

#include "flow/gaussian_source.hpp"
#include "train/batch.hpp"
#include "train/commands.hpp"
#include "train/golden.hpp"
#include "train/validation.hpp"
#include "train/weights_exchange.hpp"

namespace flowdlo::train {
namespace {

std::vector<float> values_of(const torch::Tensor& tensor) {
  const torch::Tensor flat = tensor.to(torch::kFloat32).contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

GoldenCase evaluate(const Record& record, const weights::Variant& variant) {
  VelocityModel model(variant);
  fill(*model, weights::seeded(variant, kGoldenWeightsSeed));
  model->to(torch::kFloat64);
  const ViewConfig config{variant.normalization,
                          {{kGoldenNorm[0], kGoldenNorm[1], kGoldenNorm[2]}, kGoldenNorm[3]},
                          TruthDirection::kPrior};
  const std::vector<RecordView> views{RecordView(record, 0, {}, config)};
  const auto source = torch::tensor(flow::gaussian_source(/*seed=*/0, /*draws=*/1))
                          .view({1, kNodes, 4})
                          .narrow(2, 0, 3);
  const auto after = [&](int steps) {
    return sample(*model, views, source, steps, torch::kFloat64, torch::kCPU);
  };
  const auto norm = stacked(views, &RecordView::norm, 4).view({4}).to(torch::kFloat64);
  return {variant, values_of(after(1) - source),
          values_of(after(kGoldenSteps) * norm[3] + norm.narrow(0, 0, 3))};
}

int run(const std::filesystem::path& folder) {
  const Record record = golden_record();
  std::vector<GoldenCase> cases;
  for (const auto& variant : golden_variants()) cases.push_back(evaluate(record, variant));
  const auto written = write_golden(cases, folder);
  if (written) return 0;
  fmt::print(stderr, "{}\n", written.error().message);
  return 1;
}

}  // namespace

void add_golden_command(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::filesystem::path>();
  auto* command = app.add_subcommand(
      "golden", "Write tests/golden: velocities and nodes in double precision, all variants");
  command->add_option("--out", *folder, "Folder")->required();
  command->callback([folder, &exit_code] { exit_code = run(*folder); });
}

}  // namespace flowdlo::train
