// Training in the small: it lowers the loss, resumes exactly, and its weights are the engine's.
#include "train/trainer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "evidence/mask_field.hpp"
#include "flow/gaussian_source.hpp"
#include "reference/program.hpp"
#include "support/source_dir.hpp"
#include "train/batch.hpp"
#include "train/device.hpp"
#include "train/export.hpp"
#include "train/record_conditions.hpp"
#include "train/record_folder.hpp"
#include "train/validation.hpp"

namespace flowdlo::train {
namespace {

Recipe small_recipe() {
  auto recipe = read_recipe(test::source_dir() / "lab/train/recipes/smoke.json");
  if (!recipe) throw std::runtime_error(recipe.error().message);
  recipe->optimizer.batch = 4;
  recipe->optimizer.steps = 60;
  recipe->schedule = {.validate_every = 1000, .checkpoint_every = 1000, .euler_steps = 2};
  return *recipe;
}

/// Records and runs of all tests here; records are made once.
class Trainer : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    use_threads(1);
    folder_ = std::filesystem::temp_directory_path() / "flowdlo_trainer_test";
    std::filesystem::remove_all(folder_);
    const Recipe recipe = small_recipe();
    for (const Part part : {Part::kTraining, Part::kValidation}) {
      const auto made = make_records(folder_ / "records", part, 1, recipe.data.source,
                                     recipe.record_options(), 2, {});
      ASSERT_TRUE(made) << made.error().message;
    }
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(folder_); }

  static RunOptions options(const std::string& name, std::int64_t stop_after = 0) {
    RunOptions options;
    options.folder = folder_ / name;
    options.records = folder_ / "records";
    options.stop_after = stop_after;
    return options;
  }
  static std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  static inline std::filesystem::path folder_;
};

/// steps.csv without the column of the clock.
std::string losses_of(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "steps.csv");
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    const auto last = line.rfind(',');
    const auto clock = line.rfind(',', last - 1);
    text += line.substr(0, clock) + "\n";
  }
  return text;
}

TEST(ComputeType, IsTheWantedOneOrF32AndNeverWider) {
  const torch::Device gpu(torch::kCUDA, 0);
  EXPECT_EQ(compute_type(Precision::kF32, torch::kCPU), torch::kFloat32);
  EXPECT_EQ(compute_type(Precision::kF32, gpu), torch::kFloat32);
  EXPECT_EQ(compute_type(Precision::kBf16, gpu), torch::kBFloat16);
#if defined(__x86_64__)
  const bool avx512 = __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  EXPECT_EQ(compute_type(Precision::kBf16, torch::kCPU),
            avx512 ? torch::kBFloat16 : torch::kFloat32);
#endif
}

TEST_F(Trainer, ResumedRunHasTheSameLossesToTheLastDigit) {
  Recipe recipe = small_recipe();
  recipe.optimizer.steps = 6;
  TrainingState straight = start(recipe, torch::kCPU);
  ASSERT_TRUE(train(straight, options("straight"), torch::kCPU));

  TrainingState first = start(recipe, torch::kCPU);
  ASSERT_TRUE(train(first, options("broken", 3), torch::kCPU));
  auto second = load_checkpoint(folder_ / "broken/checkpoint.pt", torch::kCPU);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->step, 3);
  ASSERT_TRUE(train(*second, options("broken"), torch::kCPU));

  EXPECT_EQ(losses_of(folder_ / "straight"), losses_of(folder_ / "broken"));
  const auto a = to_weights(straight, "").tensors;
  const auto b = to_weights(*second, "").tensors;
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].values, b[i].values) << a[i].name;
}

TEST_F(Trainer, AStateOnThePriorsPathTellsNothingOfTheTruth) {
  auto loaded = load_records(folder_ / "records", Part::kTraining);
  ASSERT_TRUE(loaded);
  std::vector<Record> records{loaded->records.front()};
  const SamplingConfig config{.rotation_share = 0, .prior_path_share = 1};
  const auto made = [&] {
    return make_batch(records, SamplePlan(records, config, 3), {}, 0, 4, 6);
  };
  const Batch batch = made();
  for (Point3& node : records[0].truth) node.x += 0.03F;
  const Batch other = made();
  EXPECT_TRUE(torch::equal(batch.input.state, other.input.state));
  EXPECT_FALSE(torch::equal(batch.target.truth, other.target.truth));
}

TEST_F(Trainer, LoaderGivesTheSameBatchesWhateverItsThreads) {
  const Recipe recipe = small_recipe();
  const auto set = load_records(folder_ / "records", Part::kTraining);
  ASSERT_TRUE(set);
  const SamplePlan plan(set->records, recipe.sampling, recipe.seed);
  const ViewConfig view{recipe.variant.normalization, {}, recipe.sampling.truth_direction};
  const Batch a = make_batch(set->records, plan, view, 5, 4, 6);
  const Batch b = make_batch(set->records, plan, view, 5, 4, 6);
  EXPECT_TRUE(torch::equal(a.input.features, b.input.features));
  EXPECT_TRUE(torch::equal(a.input.state, b.input.state));
  EXPECT_FALSE(
      torch::equal(a.input.state, make_batch(set->records, plan, view, 6, 4, 6).input.state));
}

TEST_F(Trainer, TrainingLowersTheLossAndTheEngineRunsItsWeights) {
  const Recipe recipe = small_recipe();
  TrainingState state = start(recipe, torch::kCPU);
  const auto set = load_records(folder_ / "records", Part::kTraining);
  ASSERT_TRUE(set);
  const SamplePlan plan(set->records, recipe.sampling, /*seed=*/99);
  const ViewConfig view{recipe.variant.normalization, {}, recipe.sampling.truth_direction};
  const Batch held = make_batch(set->records, plan, view, 0, 48, recipe.variant.local_channels);
  const auto loss = [&] {
    const torch::NoGradGuard no_gradients;
    const auto output = state.best().forward(held.input, torch::kFloat32);
    const auto losses = objective(recipe.variant, recipe.objective, output, held.target);
    return (losses.total).item<double>();
  };
  const double before = loss();
  ASSERT_TRUE(train(state, options("lowers"), torch::kCPU));
  EXPECT_LT(loss(), before);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "lowers/curves.png"));

  const auto file = folder_ / "trained.fdw";
  const auto weights = to_weights(state, "2000-01-01");
  ASSERT_TRUE(export_weights(weights, file, weights::StorageType::kF32));
  const auto loaded = weights::load(file);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(loaded->metadata.trained);
  EXPECT_NE(loaded->metadata.notes.find("validation"), std::string::npos);
  EXPECT_NE(loaded->metadata.training_data.find(set->sha256), std::string::npos);

  const Record& record = set->records.front();
  const testing::RecordConditions conditions(record);
  const auto predicted = conditions.sample(
      *loaded, [] { return reference::create_program(1); }, 4, 0);
  ASSERT_TRUE(predicted) << predicted.error().message;
  const std::vector<RecordView> views{RecordView(record, 0, {}, view)};
  const auto source =
      torch::tensor(flow::gaussian_source(0, 1)).view({1, kNodes, 4}).narrow(2, 0, 3);
  const auto ours = sample(state.best(), views, source, 4, torch::kFloat32, torch::kCPU);
  const auto norm = views[0].norm();
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto row = ours[0][static_cast<std::int64_t>(node)];
    EXPECT_NEAR(predicted->draws[0][node].x, row[0].item<float>() * norm[3] + norm[0], 1e-4);
    EXPECT_NEAR(predicted->draws[0][node].z, row[2].item<float>() * norm[3] + norm[2], 1e-4);
  }
}

TEST_F(Trainer, ExportAsHalfKeepsEveryTensorWithinHalfPrecision) {
  const TrainingState state = start(small_recipe(), torch::kCPU);
  const auto weights = to_weights(state, "");
  const auto file = folder_ / "half.safetensors";
  ASSERT_TRUE(export_weights(weights, file, weights::StorageType::kF16));
  EXPECT_LT(std::filesystem::file_size(file), std::uintmax_t{13} << 20U);
  EXPECT_FALSE(export_weights(weights, folder_ / "half.bin", weights::StorageType::kF16));
}

TEST(TakeRecipe, ChangesTheSamplingAndKeepsTheModel) {
  TrainingState state = start(small_recipe(), torch::kCPU);
  const auto before = state.model->parameters().front().clone();
  Recipe recipe = small_recipe();
  recipe.sampling.prior_path_share = 0.5;
  ASSERT_TRUE(take_recipe(state, recipe));
  EXPECT_EQ(state.recipe.sampling.prior_path_share, 0.5);
  EXPECT_TRUE(torch::equal(state.model->parameters().front(), before));
}

TEST(TakeRecipe, OfAnotherModelIsRefused) {
  TrainingState state = start(small_recipe(), torch::kCPU);
  Recipe recipe = small_recipe();
  recipe.variant.visible_points = !recipe.variant.visible_points;
  const auto taken = take_recipe(state, recipe);
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message.find("another variant"), std::string::npos);
}

TEST_F(Trainer, WhatIsNoCheckpointIsRefused) {
  const auto file = folder_ / "no_checkpoint.pt";
  std::ofstream(file) << "rope";
  const auto state = load_checkpoint(file, torch::kCPU);
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(load_checkpoint(folder_ / "nowhere.pt", torch::kCPU).error().code, ErrorCode::kIo);
}

TEST(LearningRate, WarmsUpThenFallsAlongACosine) {  // Sec. 4.1.3
  const OptimizerConfig config{
      .steps = 1100, .rate = 3e-4, .final_rate = 3e-6, .warmup_steps = 100};
  EXPECT_NEAR(learning_rate(config, 0), 3e-6, 1e-12);
  EXPECT_NEAR(learning_rate(config, 100), 3e-4, 1e-12);
  EXPECT_NEAR(learning_rate(config, 600), (3e-4 + 3e-6) / 2, 1e-12);
  EXPECT_NEAR(learning_rate(config, 1100), 3e-6, 1e-12);
}

TEST(AverageDecay, StartsSmallAndEndsAtTheRecipes) {
  EXPECT_DOUBLE_EQ(average_decay(0.999, 0), 0.1);
  EXPECT_DOUBLE_EQ(average_decay(0.999, 1000000), 0.999);
}

}  // namespace
}  // namespace flowdlo::train
