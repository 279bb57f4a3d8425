#include "strand/trainer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <optional>

#include "field/channel.hpp"
#include "field/sight.hpp"
#include "strand/export.hpp"
#include "strand/sample.hpp"
#include "threads/pool.hpp"
#include "train/archive_file.hpp"
#include "train/device.hpp"

namespace flowdlo::strand {
namespace {

using torch::Tensor;

constexpr int kCheckpointVersion = 1;
constexpr std::int64_t kNoteEvery = 20;  // steps

/// [n, h, w, c], as the samples have their images.
struct Batch {
  Tensor planes;
  Tensor target;
};

/// [n, c, h, w] there.
Tensor on_device(const Tensor& images, torch::Device device) {
  return images.to(device, images.scalar_type(), /*non_blocking=*/true)
      .permute({0, 3, 1, 2})
      .contiguous();
}

/// Room for so many images, which a GPU can fetch by itself.
Tensor room_for(int images, int size_px, int channels, torch::Device device) {
  return torch::empty({images, size_px, size_px, channels},
                      torch::dtype(torch::kFloat32).pinned_memory(device.is_cuda()));
}

void copy_image(const cv::Mat& image, Tensor to) {
  std::memcpy(to.data_ptr<float>(), image.data, image.total() * image.elemSize());
}

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// The samples of one step, made on a pool's threads.
class BatchMaker {
 public:
  BatchMaker(threads::Pool& pool, const PatchStore& store, const Recipe& recipe, std::int64_t step,
             torch::Device device)
      : batch_{room_for(recipe.schedule.batch, recipe.schedule.size_px, field::kPlanes, device),
               room_for(recipe.schedule.batch, recipe.schedule.size_px, field::kChannels, device)},
        faults_(static_cast<std::size_t>(recipe.schedule.batch)),
        beside_(pool, recipe.schedule.batch, [this, &store, &recipe, step](int i) {
          const auto number =
              static_cast<std::uint64_t>(step) * static_cast<std::uint64_t>(recipe.schedule.batch) +
              static_cast<std::uint64_t>(i);
          const std::uint64_t key = mixed(recipe.seed * 0x9E3779B97F4A7C15ULL + number);
          const auto patch = store.read(key % store.size());
          if (!patch) {
            faults_[static_cast<std::size_t>(i)] = patch.error();
            return;
          }
          const Sample sample =
              sample_of(*patch, recipe.schedule.size_px, recipe.seed, number, recipe.spoil);
          copy_image(sample.input, batch_.planes[i]);
          copy_image(sample.target, batch_.target[i]);
        }) {}

  Result<Batch> finish() {
    beside_.finish();
    for (const auto& fault : faults_) {
      if (fault) return *fault;
    }
    return batch_;
  }

 private:
  Batch batch_;
  std::vector<std::optional<Error>> faults_;
  threads::Beside beside_;
};

double rate_at(const Schedule& schedule, std::int64_t step) {
  const double warm =
      std::min(1.0, static_cast<double>(step + 1) / std::max(1, schedule.warmup_steps));
  const double way = std::min(1.0, static_cast<double>(step) / schedule.steps);
  const double fall = 0.5 + 0.5 * std::cos(std::numbers::pi * way);
  return warm * (schedule.final_rate + (schedule.rate - schedule.final_rate) * fall);
}

/// Parameters and batch norms' statistics alike.
template <class Visit>
void for_each_pair(Network& to, Network& from, const Visit& visit) {
  const torch::NoGradGuard no_gradients;
  const auto sources = from->named_parameters();
  for (auto& item : to->named_parameters()) visit(item.value(), sources[item.key()]);
  const auto buffers = from->named_buffers();
  for (auto& item : to->named_buffers()) visit(item.value(), buffers[item.key()]);
}

void follow(Network& average, Network& network, double decay) {
  for_each_pair(average, network, [&](Tensor& to, const Tensor& from) {
    if (to.is_floating_point()) {
      to.mul_(decay).add_(from, 1 - decay);
    } else {
      to.copy_(from);
    }
  });
}

LossParts step_once(State& state, const Batch& batch, torch::Device device) {
  const Schedule& schedule = state.recipe.schedule;
  const double rate = rate_at(schedule, state.step);
  for (auto& group : state.optimizer->param_groups()) {
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
  }
  state.network->train();
  const Tensor planes = on_device(batch.planes, device);
  const Tensor target = on_device(batch.target, device);
  const auto type = train::compute_type(schedule.precision, device);
  LossParts parts = loss_of(state.network->forward(planes.to(type)), target, planes);
  state.optimizer->zero_grad();
  parts.total(state.recipe.loss).backward();
  if (schedule.clip_norm > 0) {
    torch::nn::utils::clip_grad_norm_(state.network->parameters(), schedule.clip_norm);
  }
  state.optimizer->step();
  ++state.step;
  const double early = 1 - 1 / static_cast<double>(state.step + 1);
  follow(state.average, state.network, std::min(schedule.ema_decay, early));
  for (const LossPart& part : kLossParts) parts.*part.value = (parts.*part.value).detach();
  return parts;
}

/// The mean over these steps of what `value` says of each.
template <class Value>
double mean_of(const std::vector<LossParts>& steps, const Value& value) {
  std::vector<Tensor> values;
  for (const LossParts& parts : steps) values.push_back(value(parts));
  return torch::stack(values).mean().template item<double>();
}

}  // namespace

State start(const Recipe& recipe, torch::Device device) {
  torch::manual_seed(recipe.seed);
  State state;
  state.recipe = recipe;
  state.network = Network(recipe.network);
  state.network->to(device);
  state.average = Network(recipe.network);
  state.average->to(device);
  state.average->eval();
  for_each_pair(state.average, state.network,
                [](Tensor& to, const Tensor& from) { to.copy_(from); });
  for (auto& parameter : state.average->parameters()) parameter.set_requires_grad(false);
  state.optimizer = std::make_unique<torch::optim::AdamW>(
      state.network->parameters(),
      torch::optim::AdamWOptions(recipe.schedule.rate).weight_decay(recipe.schedule.weight_decay));
  return state;
}

namespace {

/// A new run whose networks are both `taught`.
Result<State> start_as(Network taught, const Recipe& recipe, torch::Device device) {
  const NetworkConfig& had = taught->config;
  const NetworkConfig& wanted = recipe.network;
  if (had.fine != wanted.fine || had.middle != wanted.middle || had.coarse != wanted.coarse) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("{}: expected the network of the run that it begins from, {} / {} / {} "
                    "channels, got {} / {} / {}; change one of both recipes",
                    recipe.name, had.fine, had.middle, had.coarse, wanted.fine, wanted.middle,
                    wanted.coarse)};
  }
  State state = start(recipe, device);
  for (Network network : {state.network, state.average}) {
    for_each_pair(network, taught, [](Tensor& to, const Tensor& from) { to.copy_(from); });
  }
  return state;
}

/// Gives every batch norm the statistics of these planes, and scale and shift under which it still
/// does what it did.
void settle_norms(Network network, const Tensor& planes) {
  const torch::NoGradGuard no_gradients;
  network->eval();
  network->forward(planes, [](torch::nn::BatchNorm2dImpl& norm, const Tensor& given) {
    const double eps = norm.options.eps();
    const Tensor gain = norm.weight / torch::sqrt(norm.running_var + eps);
    const Tensor shift = norm.bias - norm.running_mean * gain;
    norm.running_mean.copy_(given.mean({0, 2, 3}));
    norm.running_var.copy_(given.var({0, 2, 3}, /*unbiased=*/false));
    norm.weight.copy_(gain * torch::sqrt(norm.running_var + eps));
    norm.bias.copy_(shift + norm.running_mean * gain);
  });
}

}  // namespace

Result<State> start_from(const State& earlier, const Recipe& recipe, torch::Device device) {
  return start_as(earlier.average, recipe, device);
}

Result<State> start_from(const weights::FieldWeights& earlier, const PatchStore& patches,
                         const Recipe& recipe, torch::Device device) {
  constexpr int kBatches = 8;  // whose statistics the norms begin with
  Network taught = imported(earlier);
  threads::Pool pool(1);
  std::vector<Tensor> planes;
  for (int i = 0; i < kBatches; ++i) {
    const auto batch = BatchMaker(pool, patches, recipe, i, torch::kCPU).finish();
    if (!batch) return batch.error();
    planes.push_back(on_device(batch->planes, torch::kCPU));
  }
  settle_norms(taught, torch::cat(planes));
  return start_as(taught, recipe, device);
}

Result<void> save_checkpoint(const State& state, const std::filesystem::path& file) {
  return train::write_archive(file, [&](torch::serialize::OutputArchive& archive) {
    archive.write("field_version", c10::IValue(kCheckpointVersion));
    archive.write("step", c10::IValue(state.step));
    train::put_text(archive, "recipe", to_json(state.recipe));
    train::put_text(archive, "command", state.command);
    train::write_module(archive, "network", *state.network);
    train::write_module(archive, "average", *state.average);
    torch::serialize::OutputArchive optimizer;
    state.optimizer->save(optimizer);
    archive.write("optimizer", optimizer);
  });
}

Result<State> load_checkpoint(const std::filesystem::path& file, torch::Device device) {
  const auto read = [&](torch::serialize::InputArchive& archive) -> Result<State> {
    if (train::get_whole(archive, "field_version") != kCheckpointVersion) {
      throw std::runtime_error("another version");
    }
    const auto recipe =
        parse_recipe(train::get_text(archive, "recipe"), file.string() + ": recipe");
    if (!recipe) return recipe.error();
    State state = start(*recipe, device);
    state.step = train::get_whole(archive, "step");
    state.command = train::get_text(archive, "command");
    train::read_module(archive, "network", *state.network);
    train::read_module(archive, "average", *state.average);
    torch::serialize::InputArchive optimizer;
    archive.read("optimizer", optimizer);
    state.optimizer->load(optimizer);
    return state;
  };
  return train::read_archive<State>(file, device, "flowdlo-train field", read);
}

Result<void> train(State& state, const RunOptions& options, torch::Device device) {
  using Clock = std::chrono::steady_clock;
  const Schedule& schedule = state.recipe.schedule;
  auto store = PatchStore::open(options.patches);
  if (!store) return store.error();
  threads::Pool pool(1 + options.threads);
  const std::int64_t last =
      options.stop_after > 0
          ? std::min<std::int64_t>(schedule.steps, state.step + options.stop_after)
          : schedule.steps;
  std::error_code ignored;
  std::filesystem::create_directories(options.folder, ignored);
  std::ofstream log(options.folder / "steps.csv", std::ios::app);
  if (log.tellp() == 0) {
    log << "step,rate,total";
    for (const LossPart& part : kLossParts) log << ',' << part.name;
    log << '\n';
  }
  at::globalContext().setBenchmarkCuDNN(true);
  auto maker = std::make_unique<BatchMaker>(pool, *store, state.recipe, state.step, device);
  auto begin = Clock::now();
  std::vector<LossParts> noted;  // of the steps since the last note
  while (state.step < last) {
    const auto batch = maker->finish();
    if (!batch) return batch.error();
    const bool checkpoint = (state.step + 1) % schedule.checkpoint_every == 0;
    if (checkpoint) {
      maker.reset();
      if (auto grown = PatchStore::open(options.patches)) store = std::move(grown);
    }
    maker = std::make_unique<BatchMaker>(pool, *store, state.recipe, state.step + 1, device);
    noted.push_back(step_once(state, *batch, device));
    const bool note = state.step % kNoteEvery == 0;
    const bool saves = checkpoint || state.step == last;
    if (!note && !saves) continue;  // asking a GPU for a value makes it wait
    const double value =
        mean_of(noted, [&](const LossParts& parts) { return parts.total(state.recipe.loss); });
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInternal,
                   fmt::format("flowdlo-train field: expected a finite loss, got {} at step {}; "
                               "lower schedule.rate",
                               value, state.step)};
    }
    if (note) {
      const std::chrono::duration<double> elapsed = Clock::now() - begin;
      log << fmt::format("{},{:.3g},{:.5g}", state.step, rate_at(schedule, state.step), value);
      std::string told;
      for (const LossPart& part : kLossParts) {
        const double mean =
            mean_of(noted, [&](const LossParts& parts) { return parts.*part.value; });
        log << fmt::format(",{:.5g}", mean);
        told += fmt::format("  {} {:.5f}", part.name, mean);
      }
      log << std::endl;
      if (options.on_note) {
        options.on_note(fmt::format("{}/{}  loss {:.4f}{}  {} patches  {:.3f} s a step", state.step,
                                    schedule.steps, value, told, store->size(),
                                    elapsed.count() / static_cast<double>(noted.size())));
      }
      noted.clear();
      begin = Clock::now();
    }
    if (saves) {
      const auto saved = save_checkpoint(state, options.folder / "checkpoint.pt");
      if (!saved) return saved;
    }
  }
  return {};
}

}  // namespace flowdlo::strand
