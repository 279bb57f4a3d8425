// flowdlo-train field-patches and field: data and training of the strand field.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "field/channel.hpp"
#include "field/sight.hpp"
#include "mat/mat_file.hpp"
#include "progress_bar.hpp"
#include "strand/export.hpp"
#include "strand/mean.hpp"
#include "strand/patch_store.hpp"
#include "strand/recipe.hpp"
#include "strand/sample.hpp"
#include "strand/trainer.hpp"
#include "threads/count.hpp"
#include "train/commands.hpp"
#include "train/device.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::train {
namespace {

struct PatchArguments {
  std::filesystem::path recipe;
  std::filesystem::path folder;
  std::uint64_t scenes = 0;
  int threads = 0;
  bool quiet = false;
};

struct LookArguments {
  std::filesystem::path recipe;
  std::filesystem::path patches;
  std::filesystem::path file;
  std::uint64_t first = 0;
  std::uint64_t count = 12;
};

struct ExportArguments {
  std::filesystem::path folder;
  std::filesystem::path file;
  std::filesystem::path beside;
};

struct MeanArguments {
  std::vector<std::filesystem::path> fields;
  std::filesystem::path file;
  std::filesystem::path beside;
};

struct FieldArguments {
  std::filesystem::path recipe;
  std::filesystem::path folder;
  std::filesystem::path from;
  std::filesystem::path patches;
  std::string device = "auto";
  int threads = 0;
  int sample_threads = 1;
  std::int64_t stop_after = 0;
  bool quiet = false;
  std::string command;
};

int make_patches(const PatchArguments& arguments) {
  const auto recipe = strand::read_recipe(arguments.recipe);
  if (!recipe) return failed(recipe.error(), 2);
  strand::DataConfig data = recipe->data;
  if (arguments.scenes > 0) data.scenes = arguments.scenes;
  support::ProgressBar bar("scenes", static_cast<int>(data.scenes), arguments.quiet);
  const auto made = strand::make_patches(arguments.folder, data, threads::count(arguments.threads),
                                         [&] { bar.advance(); });
  bar.clear();
  if (!made) return failed(made.error());
  const auto store = strand::PatchStore::open(arguments.folder);
  if (!store) return failed(store.error());
  fmt::print("{} patches in {}\n", store->size(), arguments.folder.string());
  return 0;
}

/// Colour, depth, mask, centre and direction, tip and under, width and edge, side by side.
cv::Mat shown(const strand::Sample& sample) {
  const cv::Size size = sample.input.size();
  cv::Mat row(size.height, 6 * size.width, CV_8UC3);
  const auto byte = [](float value) { return cv::saturate_cast<std::uint8_t>(255 * value); };
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const float* in = sample.input.ptr<float>(v) + u * field::kPlanes;
      const float* out = sample.target.ptr<float>(v) + u * field::kChannels;
      const auto at = [&](int panel) -> cv::Vec3b& {
        return row.at<cv::Vec3b>(v, panel * size.width + u);
      };
      const auto signed_byte = [&](float value) { return byte(0.5F + value / 6); };
      at(0) = {signed_byte(in[field::kBlue]), signed_byte(in[field::kGreen]),
               signed_byte(in[field::kRed])};
      at(1) = cv::Vec3b::all(in[field::kHasDepth] > 0 ? signed_byte(in[field::kDepth]) : 0);
      at(2) = cv::Vec3b::all(byte(in[field::kMask]));
      const float centre = out[field::kCentre];
      at(3) = {byte(centre * (0.5F + 0.5F * out[field::kCos])),
               byte(centre * (0.5F + 0.5F * out[field::kSin])), byte(centre)};
      at(4) = {byte(out[field::kUnder]), byte(0.5F * out[field::kRope]), byte(out[field::kTip])};
      at(5) = {byte(out[field::kEdge]), byte(0.5F * out[field::kRope]),
               byte(out[field::kRope] * (0.5F + 0.3F * out[field::kWidth]))};
    }
  }
  return row;
}

int look_at_samples(const LookArguments& arguments) {
  const auto recipe = strand::read_recipe(arguments.recipe);
  if (!recipe) return failed(recipe.error(), 2);
  const auto store = strand::PatchStore::open(arguments.patches);
  if (!store) return failed(store.error());
  cv::Mat sheet;
  for (std::uint64_t i = 0; i < arguments.count; ++i) {
    const auto patch = store->read((arguments.first + 7919 * i) % store->size());
    if (!patch) return failed(patch.error());
    sheet.push_back(shown(strand::sample_of(*patch, recipe->schedule.size_px, recipe->seed,
                                            arguments.first + i, recipe->spoil)));
  }
  const auto written = mat::save_png(arguments.file, sheet);
  return written ? 0 : failed(written.error());
}

/// Saves a field, with the other networks and the calibration of `beside` unless that is empty.
Result<void> save_beside(weights::FieldWeights field, const std::filesystem::path& beside,
                         const std::filesystem::path& file) {
  if (!beside.empty()) {
    auto other = weights::load_field(beside);
    if (!other) return other.error();
    field.refine = std::move(other->refine);
    field.links = std::move(other->links);
    field.tips = std::move(other->tips);
    field.calibration = std::move(other->calibration);
  }
  return weights::save_field(field, file);
}

int export_field(const ExportArguments& arguments) {
  const auto state = strand::load_checkpoint(arguments.folder / "checkpoint.pt", torch::kCPU);
  if (!state) return failed(state.error());
  const auto saved =
      save_beside(strand::exported(*state, fmt::format("{}; step {}", state->command, state->step)),
                  arguments.beside, arguments.file);
  if (!saved) return failed(saved.error());
  fmt::print("{}: step {}\n", arguments.file.string(), state->step);
  return 0;
}

int mean_field(const MeanArguments& arguments) {
  std::vector<weights::FieldWeights> fields;
  for (const auto& file : arguments.fields) {
    auto field = weights::load_field(file);
    if (!field) return failed(field.error());
    fields.push_back(std::move(*field));
  }
  auto mean = strand::mean_of(fields);
  if (!mean) return failed(mean.error(), 2);
  const auto saved = save_beside(std::move(*mean), arguments.beside, arguments.file);
  if (!saved) return failed(saved.error());
  fmt::print("{}: mean of {}\n", arguments.file.string(), fields.size());
  return 0;
}

/// The run in --out; where there is none yet, a new one.
Result<strand::State> begun(const FieldArguments& arguments, const strand::Recipe& recipe,
                            torch::Device device) {
  const auto checkpoint = arguments.folder / "checkpoint.pt";
  if (std::filesystem::exists(checkpoint)) return strand::load_checkpoint(checkpoint, device);
  if (arguments.from.empty()) return strand::start(recipe, device);
  if (!std::filesystem::is_directory(arguments.from)) {
    const auto earlier = weights::load_field(arguments.from);
    if (!earlier) return earlier.error();
    const auto patches = strand::PatchStore::open(arguments.patches);
    if (!patches) return patches.error();
    return strand::start_from(*earlier, *patches, recipe, device);
  }
  const auto earlier = strand::load_checkpoint(arguments.from / "checkpoint.pt", device);
  if (!earlier) return earlier.error();
  return strand::start_from(*earlier, recipe, device);
}

int train_field(const FieldArguments& arguments) {
  const auto device = choose_device(arguments.device);
  if (!device) return failed(device.error(), 2);
  use_threads(arguments.threads);
  fmt::print("device: {}\n", describe(*device));
  const auto recipe = strand::read_recipe(arguments.recipe);
  if (!recipe) return failed(recipe.error(), 2);
  auto state = begun(arguments, *recipe, *device);
  if (!state) return failed(state.error());
  if (strand::to_json(state->recipe) != strand::to_json(*recipe)) {
    return failed({ErrorCode::kBadInput,
                   fmt::format("{}: expected the recipe of the checkpoint in {}; use that one, or "
                               "another folder",
                               arguments.recipe.string(), arguments.folder.string())},
                  2);
  }
  state->command = fmt::format("{}; {}", arguments.command, describe(*device));
  strand::RunOptions options;
  options.folder = arguments.folder;
  options.patches = arguments.patches;
  options.threads = arguments.sample_threads;
  options.stop_after = arguments.stop_after;
  if (!arguments.quiet) {
    options.on_note = [](const std::string& line) {
      fmt::print("{}\n", line);
      std::fflush(stdout);
    };
  }
  const auto trained = strand::train(*state, options, *device);
  if (!trained) return failed(trained.error());
  fmt::print("{} steps done; checkpoint and log in {}\n", state->step, arguments.folder.string());
  return 0;
}

}  // namespace

void add_field_commands(CLI::App& app, int argc, char** argv, int& exit_code) {
  auto patches = std::make_shared<PatchArguments>();
  auto* make = app.add_subcommand(
      "field-patches",
      "Render what the strand field is trained on. Goes on where an earlier call stopped; a "
      "training run takes up what is added meanwhile.");
  make->add_option("recipe", patches->recipe, "Recipe of a strand field, JSON")->required();
  make->add_option("--out", patches->folder, "Folder for the shards")->required();
  make->add_option("--scenes", patches->scenes, "Scenes instead of the recipe's number");
  make->add_option("--threads", patches->threads, "0: one a core")->check(CLI::Range(0, 1024));
  make->add_flag("--quiet", patches->quiet, "No progress bar");
  make->callback([patches, &exit_code] { exit_code = make_patches(*patches); });

  auto look = std::make_shared<LookArguments>();
  auto* picture = app.add_subcommand(
      "field-look", "Draw samples as the network meets them, and what it should say of them");
  picture->add_option("recipe", look->recipe, "Recipe of a strand field, JSON")->required();
  picture->add_option("--patches", look->patches, "Folder that field-patches filled")->required();
  picture->add_option("--out", look->file, "PNG")->required();
  picture->add_option("--first", look->first, "Number of the first sample");
  picture->add_option("--count", look->count, "Samples, one below another")
      ->check(CLI::Range(1, 200));
  picture->callback([look, &exit_code] { exit_code = look_at_samples(*look); });

  auto out = std::make_shared<ExportArguments>();
  auto* write = app.add_subcommand("field-export", "A checkpoint as the engine reads it");
  write->add_option("folder", out->folder, "Folder of the checkpoint")->required();
  write->add_option("file", out->file, ".safetensors to write")->required();
  write->add_option("--beside", out->beside,
                    "Exported .safetensors whose other networks and calibration are taken over");
  write->callback([out, &exit_code] { exit_code = export_field(*out); });

  auto several = std::make_shared<MeanArguments>();
  auto* mean = app.add_subcommand(
      "field-mean", "The mean of the weights of fields whose runs began with the same ones");
  mean->add_option("fields", several->fields, "Exported .safetensors")->required();
  mean->add_option("--out", several->file, ".safetensors to write")->required();
  mean->add_option("--beside", several->beside,
                   "Exported .safetensors whose other networks and calibration are taken over");
  mean->callback([several, &exit_code] { exit_code = mean_field(*several); });

  auto arguments = std::make_shared<FieldArguments>();
  arguments->command = "flowdlo-train";
  for (int i = 1; i < argc; ++i) arguments->command += std::string(" ") + argv[i];
  auto* field = app.add_subcommand(
      "field", "Train a strand field; goes on, exactly, from a checkpoint that is in --out");
  field->add_option("recipe", arguments->recipe, "Recipe of a strand field, JSON")->required();
  field->add_option("--out", arguments->folder, "Folder of checkpoint and log")->required();
  field->add_option(
      "--from", arguments->from,
      "Folder of an earlier run, or exported .safetensors, whose network a new run begins "
      "with");
  field->add_option("--patches", arguments->patches, "Folder that field-patches filled")
      ->required();
  field->add_option("--device", arguments->device, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  field->add_option("--threads", arguments->threads, "Of the CPU; 0: one a core")
      ->check(CLI::Range(0, 1024));
  field->add_option("--sample-threads", arguments->sample_threads, "Threads that make samples")
      ->check(CLI::Range(1, 1024));
  field->add_option("--stop-after", arguments->stop_after, "End this call after so many steps");
  field->add_flag("--quiet", arguments->quiet, "No lines of progress");
  field->callback([arguments, &exit_code] { exit_code = train_field(*arguments); });
}

}  // namespace flowdlo::train
