#include "train/training_state.hpp"

#include <fmt/format.h>

#include <vector>

#include "train/archive_file.hpp"

namespace flowdlo::train {
namespace {

using torch::Tensor;

constexpr int kCheckpointVersion = 1;
constexpr double kFirstLogSigma = -3;  // of the rope's size; spares the first steps

/// Decay shrinks matrices alone; e_j is a table, gamma a scalar, the rest are shifts and gains.
bool decays(const std::string& name, const Tensor& parameter) {
  return parameter.dim() == 2 && name != "node";
}

std::unique_ptr<torch::optim::AdamW> make_optimizer(const Recipe& recipe,
                                                    const VelocityModelImpl& model) {
  const OptimizerConfig& config = recipe.optimizer;
  const auto options = [&](double decay) {
    return std::make_unique<torch::optim::AdamWOptions>(torch::optim::AdamWOptions(config.rate)
                                                            .betas({config.beta1, config.beta2})
                                                            .eps(config.epsilon)
                                                            .weight_decay(decay));
  };
  std::vector<Tensor> decaying;
  std::vector<Tensor> others;
  std::vector<Tensor> head;
  for (const auto& item : model.named_parameters()) {
    const bool of_head = item.key().starts_with("head.");
    auto& group = of_head ? head : decays(item.key(), item.value()) ? decaying : others;
    group.push_back(item.value());
  }
  std::vector<torch::optim::OptimizerParamGroup> groups;
  groups.emplace_back(decaying, options(config.weight_decay));
  groups.emplace_back(others, options(0));
  groups.emplace_back(head, options(0));  // kHeadGroup
  return std::make_unique<torch::optim::AdamW>(groups);
}

VelocityModel copy_of(const VelocityModelImpl& model, torch::Device device) {
  const torch::NoGradGuard no_gradients;
  VelocityModel copy(model.variant);
  copy->to(device);
  auto to = copy->named_parameters();
  for (const auto& item : model.named_parameters()) to[item.key()].copy_(item.value());
  for (auto& parameter : copy->parameters()) parameter.set_requires_grad(false);
  return copy;
}

}  // namespace

TrainingState start(const Recipe& recipe, torch::Device device) {
  torch::manual_seed(recipe.seed);
  TrainingState state;
  state.recipe = recipe;
  state.model = VelocityModel(recipe.variant);
  {
    const torch::NoGradGuard no_gradients;
    if (recipe.variant.parameterization == ops::Parameterization::kPreconditioned) {
      state.model->head->weight.zero_();
      state.model->head->bias.zero_();
    }
    if (recipe.variant.head_channels == 4) state.model->head->bias[3].fill_(kFirstLogSigma);
  }
  state.model->to(device);
  if (recipe.optimizer.ema_decay > 0) state.average = copy_of(*state.model, device);
  state.optimizer = make_optimizer(recipe, *state.model);
  return state;
}

Result<void> save_checkpoint(const TrainingState& state, const std::filesystem::path& file) {
  return write_archive(file, [&](torch::serialize::OutputArchive& archive) {
    archive.write("version", c10::IValue(kCheckpointVersion));
    archive.write("step", c10::IValue(state.step));
    archive.write("shards", c10::IValue(static_cast<std::int64_t>(state.shards)));
    put_text(archive, "recipe", to_json(state.recipe));
    put_text(archive, "command", state.command);
    put_text(archive, "data_sha256", state.data_sha256);
    put_text(archive, "data_origin", state.data_origin);
    put_text(archive, "device", state.device);
    put_text(archive, "validation", state.validation);
    const auto& mean = state.norm.mean;
    archive.write("norm", torch::tensor({mean[0], mean[1], mean[2], state.norm.scale}));
    write_module(archive, "model", *state.model);
    if (state.average) write_module(archive, "average", *state.average);
    torch::serialize::OutputArchive optimizer;
    state.optimizer->save(optimizer);
    archive.write("optimizer", optimizer);
  });
}

Result<TrainingState> load_checkpoint(const std::filesystem::path& file, torch::Device device) {
  const auto read = [&](torch::serialize::InputArchive& archive) -> Result<TrainingState> {
    if (get_whole(archive, "version") != kCheckpointVersion) {
      throw std::runtime_error("another version");
    }
    const auto recipe = parse_recipe(get_text(archive, "recipe"), file.string() + ": recipe");
    if (!recipe) return recipe.error();
    TrainingState state = start(*recipe, device);
    state.step = get_whole(archive, "step");
    state.shards = static_cast<std::uint32_t>(get_whole(archive, "shards"));
    state.command = get_text(archive, "command");
    state.data_sha256 = get_text(archive, "data_sha256");
    state.data_origin = get_text(archive, "data_origin");
    state.device = get_text(archive, "device");
    state.validation = get_text(archive, "validation");
    Tensor norm;
    archive.read("norm", norm);
    norm = norm.to(torch::kCPU);
    const float* values = norm.data_ptr<float>();
    state.norm = {{values[0], values[1], values[2]}, values[3]};
    read_module(archive, "model", *state.model);
    if (state.average) read_module(archive, "average", *state.average);
    torch::serialize::InputArchive optimizer;
    archive.read("optimizer", optimizer);
    state.optimizer->load(optimizer);
    return state;
  };
  return read_archive<TrainingState>(file, device, "flowdlo-train", read);
}

Result<void> take_recipe(TrainingState& state, const Recipe& recipe) {
  std::string faults;
  if (recipe.variant != state.recipe.variant) {
    faults += " another variant: expected the checkpoint's;";
  }
  if ((recipe.optimizer.ema_decay > 0) != static_cast<bool>(state.average)) {
    faults += " optimizer.ema_decay: expected averaging on or off as in the checkpoint;";
  }
  if (!faults.empty()) {
    return Error{ErrorCode::kBadInput,
                 "recipe " + recipe.name + ":" + faults + " start a new run for another model"};
  }
  state.recipe = recipe;
  return {};
}

}  // namespace flowdlo::train
