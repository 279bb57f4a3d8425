#include <gtest/gtest.h>

#include <cmath>

#include "field/network.hpp"
#include "field/sight.hpp"
#include "frame/temporary_folder.hpp"
#include "mat/mat_image.hpp"
#include "reference/program.hpp"
#include "strand/export.hpp"
#include "strand/patch_store.hpp"
#include "strand/sample.hpp"
#include "strand/trainer.hpp"

namespace flowdlo::strand {
namespace {

Recipe small_recipe() {
  Recipe recipe;
  recipe.name = "test";
  recipe.seed = 3;
  recipe.network = {16, 16, 16};
  recipe.data.patch = {.each = 1, .half_widths = 8, .least_half_px = 24};
  recipe.schedule.batch = 4;
  recipe.schedule.size_px = 64;
  recipe.schedule.steps = 60;
  recipe.schedule.warmup_steps = 5;
  recipe.schedule.checkpoint_every = 20;
  return recipe;
}

class FieldTraining : public ::testing::Test {
 protected:
  /// Patches are made once, in the first test: a folder is named after the test that makes it.
  void SetUp() override {
    if (folder_ != nullptr) return;
    folder_ = new test::TemporaryFolder;
    const auto made =
        make_patches(patches(), {.scenes = 1, .patch = small_recipe().data.patch}, 2, [] {});
    ASSERT_TRUE(made) << made.error().message;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::filesystem::path patches() { return folder_->path() / "patches"; }

  static RunOptions options(const std::string& name, std::int64_t stop_after = 0) {
    RunOptions options;
    options.folder = folder_->path() / name;
    options.patches = patches();
    options.stop_after = stop_after;
    return options;
  }
  static double largest_difference(const State& a, const State& b) {
    double worst = 0;
    const auto other = b.network->named_parameters();
    for (const auto& item : a.network->named_parameters()) {
      worst = std::max(worst, (item.value() - other[item.key()]).abs().max().item<double>());
    }
    return worst;
  }

  static test::TemporaryFolder* folder_;
};

test::TemporaryFolder* FieldTraining::folder_ = nullptr;

TEST_F(FieldTraining, LowersTheLoss) {
  State state = start(small_recipe(), torch::kCPU);
  std::vector<double> losses;
  RunOptions run = options("lowers");
  run.on_note = [&](const std::string& line) {
    losses.push_back(std::stod(line.substr(line.find("loss ") + 5)));
  };
  const auto trained = train(state, run, torch::kCPU);
  ASSERT_TRUE(trained) << trained.error().message;
  ASSERT_EQ(losses.size(), 3U);
  EXPECT_LT(losses.back(), 0.7 * losses.front());
}

TEST(FieldLoss, HasAGradientWhereTheNetworkSaysNothing) {
  auto output = torch::zeros({2, field::kChannels, 16, 16}, torch::requires_grad());
  const auto target = torch::full({2, field::kChannels, 16, 16}, 0.7);
  const auto planes = torch::ones({2, field::kPlanes, 16, 16});
  loss_of(output, target, planes).total(LossConfig()).backward();
  EXPECT_TRUE(torch::isfinite(output.grad()).all().item<bool>());
  for (int c = 0; c < field::kChannels; ++c) {
    EXPECT_GT(output.grad().select(1, c).abs().max().item<double>(), 0) << "channel " << c;
  }
}

TEST(FieldLoss, IsThatOfTheAnglesBetweenDirections) {
  auto output = torch::zeros({1, field::kChannels, 8, 8});
  auto target = torch::zeros({1, field::kChannels, 8, 8});
  const auto planes = torch::ones({1, field::kPlanes, 8, 8});
  target.select(1, field::kCentre).fill_(1);
  target.select(1, field::kCos).fill_(1);
  output.select(1, field::kCos).fill_(0.3);  // 30 degrees, of any length
  output.select(1, field::kSin).fill_(0.3 * std::tan(std::acos(-1.0) / 6));
  const double pixels = 64;
  const double expected = pixels * (1 - std::cos(std::acos(-1.0) / 6)) / (pixels + 1);
  EXPECT_NEAR(loss_of(output, target, planes).direction.item<double>(), expected, 1e-4);
}

TEST(FieldNetwork, SaysTheSameInBf16ButForRounding) {
  torch::manual_seed(1);
  Network network(NetworkConfig{16, 16, 16});
  network->eval();
  const torch::NoGradGuard no_gradients;
  const auto planes = torch::randn({2, field::kPlanes, 32, 32});
  const auto whole = network->forward(planes);
  const auto half = network->forward(planes.to(torch::kBFloat16));
  EXPECT_EQ(half.scalar_type(), torch::kFloat32);
  const double off = (half - whole).abs().max().item<double>();
  EXPECT_LT(off, 0.03 * whole.abs().max().item<double>());
  EXPECT_GT(off, 0) << "nothing was computed in bf16";
}

TEST_F(FieldTraining, ResumesExactly) {
  State whole = start(small_recipe(), torch::kCPU);
  ASSERT_TRUE(train(whole, options("whole", 30), torch::kCPU));

  State half = start(small_recipe(), torch::kCPU);
  ASSERT_TRUE(train(half, options("half", 17), torch::kCPU));
  auto resumed = load_checkpoint(options("half").folder / "checkpoint.pt", torch::kCPU);
  ASSERT_TRUE(resumed) << resumed.error().message;
  EXPECT_EQ(resumed->step, 17);
  ASSERT_TRUE(train(*resumed, options("half", 13), torch::kCPU));
  EXPECT_EQ(largest_difference(whole, *resumed), 0);
}

TEST_F(FieldTraining, ANewRunMayBeginWithWhatAnEarlierOneLearned) {
  State earlier = start(small_recipe(), torch::kCPU);
  ASSERT_TRUE(train(earlier, options("earlier", 10), torch::kCPU));
  Recipe recipe = small_recipe();
  recipe.seed = 4;
  const auto begun = start_from(earlier, recipe, torch::kCPU);
  ASSERT_TRUE(begun) << begun.error().message;
  EXPECT_EQ(begun->step, 0);
  const auto learned = earlier.average->named_parameters();
  for (const auto& item : begun->network->named_parameters()) {
    EXPECT_TRUE(torch::equal(item.value(), learned[item.key()])) << item.key();
  }
  EXPECT_GT(largest_difference(*begun, start(recipe, torch::kCPU)), 1e-3);
  recipe.network.coarse = 32;
  const auto other = start_from(earlier, recipe, torch::kCPU);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kBadInput);
}

TEST_F(FieldTraining, ANewRunMayBeginWithExportedWeights) {
  State earlier = start(small_recipe(), torch::kCPU);
  ASSERT_TRUE(train(earlier, options("exported", 20), torch::kCPU));
  const auto store = PatchStore::open(patches());
  ASSERT_TRUE(store);
  const auto begun = start_from(exported(earlier, ""), *store, small_recipe(), torch::kCPU);
  ASSERT_TRUE(begun) << begun.error().message;
  EXPECT_EQ(begun->step, 0);
  const torch::NoGradGuard no_gradients;
  const auto planes = torch::randn({4, field::kPlanes, 64, 64});
  earlier.average->eval();
  Network same = begun->network;
  same->eval();
  const auto said = earlier.average->forward(planes);
  EXPECT_LT((same->forward(planes) - said).abs().max().item<double>(),
            1e-3 * said.abs().max().item<double>());
  // The norms have the statistics of samples: training begins where the earlier run ended.
  for (const auto& item : begun->network->named_buffers()) {
    if (item.key().find("running_var") == std::string::npos) continue;
    EXPECT_GT((item.value() - 1).abs().max().item<double>(), 1e-3) << item.key();
  }
  auto recipe = small_recipe();
  recipe.network.fine = 32;
  EXPECT_FALSE(start_from(exported(earlier, ""), *store, recipe, torch::kCPU));
}

TEST_F(FieldTraining, WhatIsNoCheckpointIsRefused) {
  EXPECT_FALSE(load_checkpoint(folder_->path() / "none.pt", torch::kCPU));
  const auto fault = load_checkpoint(patches() / "patches_00000.bin", torch::kCPU);
  ASSERT_FALSE(fault);
  EXPECT_EQ(fault.error().code, ErrorCode::kBadInput);
}

TEST_F(FieldTraining, TheEngineSeesWhatTheTrainedNetworkSays) {
  State state = start(small_recipe(), torch::kCPU);
  ASSERT_TRUE(train(state, options("parity", 20), torch::kCPU));
  const auto file = folder_->path() / "field.safetensors";
  const auto saved = weights::save_field(exported(state, "test"), file);
  ASSERT_TRUE(saved) << saved.error().message;
  const auto weights = weights::load_field(file);
  ASSERT_TRUE(weights) << weights.error().message;

  const auto store = PatchStore::open(patches());
  ASSERT_TRUE(store);
  const Sample sample = sample_of(*store->read(0), 128, 1, 1);
  auto network = field::Network::create(std::make_shared<const weights::FieldWeights>(*weights),
                                        [] { return reference::create_program(2); });
  ASSERT_TRUE(network) << network.error().message;
  const auto seen = network->see(mat::image_of<std::array<float, field::kPlanes>>(sample.input),
                                 field::blocks_near(image::Image<float>({128, 128}, 1.0F)));
  ASSERT_TRUE(seen) << seen.error().message;
  const auto got = seen->whole();

  const torch::NoGradGuard no_gradients;
  const auto planes =
      torch::from_blob(sample.input.data, {1, 128, 128, field::kPlanes}).permute({0, 3, 1, 2});
  const auto want = state.average->forward(planes.contiguous()).permute({0, 2, 3, 1}).contiguous();
  const float* const expected = want.data_ptr<float>();
  double worst = 0;
  for (int i = 0; i < 128 * 128; ++i) {
    const auto& values = got.data()[i];
    for (int c = 0; c < field::kChannels; ++c) {
      const bool logit = c == field::kCentre || c == field::kTip || c == field::kUnder ||
                         c == field::kRope || c == field::kEdge;
      const auto value = static_cast<double>(expected[i * field::kChannels + c]);
      const double said = logit ? 1 / (1 + std::exp(-value)) : value;
      worst = std::max(worst,
                       std::abs(said - static_cast<double>(values[static_cast<std::size_t>(c)])));
    }
  }
  EXPECT_LT(worst, 5e-3) << "weights are f16 in the file";
  EXPECT_GT(cv::norm(mat::mat_over(got), cv::NORM_INF), 0.05);
}

}  // namespace
}  // namespace flowdlo::strand
