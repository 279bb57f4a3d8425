#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "frame/temporary_folder.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "refine/network.hpp"
#include "refining/recipe.hpp"
#include "refining/strip_store.hpp"
#include "refining/trainer.hpp"
#include "refining/uneven.hpp"
#include "support/source_dir.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::refining {
namespace {

/// Strips of noise whose first column of depth on the mask says how deep the rope lies.
std::vector<StripSample> strips(int count) {
  std::mt19937 random(5);
  std::normal_distribution<float> value(0, 1);
  std::vector<StripSample> samples;
  for (int scene = 0; scene < count; ++scene) {
    StripSample sample;
    sample.truth.scene = static_cast<std::uint64_t>(scene);
    sample.truth.radius_m = 0.005F;
    sample.truth.index_mm = 1;
    sample.strip.values.assign(static_cast<std::size_t>(refine::kStations) * weights::kRefineInputs,
                               0.0F);
    for (std::size_t node = 0; node < kNodes; ++node) {
      const float deep = 0.3F * value(random);
      sample.truth.deep[node] = deep;
      for (std::size_t station = 0; station < refine::kStationsOfNode; ++station) {
        auto* const row = sample.strip.values.data() +
                          (node * refine::kStationsOfNode + station) * weights::kRefineInputs;
        for (int k = 0; k < refine::kAcross; ++k)
          row[refine::kDepthOnMask * refine::kAcross + k] = deep;
        row[refine::kSlope] = 0.1F * value(random);
      }
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

Recipe short_recipe(int steps) {
  Recipe recipe;
  recipe.name = "test";
  recipe.schedule.steps = steps;
  recipe.schedule.batch = 4;
  recipe.schedule.warmup_steps = 5;
  recipe.schedule.ema_decay = 0.9;
  return recipe;
}

TEST(Refining, TheEngineSaysWhatTheTrainedNetworkSays) {
  torch::manual_seed(4);
  Network network;
  {
    const torch::NoGradGuard no_gradients;
    torch::nn::init::normal_(network->head->weight, 0, 0.1);
    torch::nn::init::normal_(network->head->bias, 0, 0.1);
  }
  const auto sample = strips(1).front();
  const torch::NoGradGuard no_gradients;
  const auto expected = network
                            ->forward(torch::tensor(sample.strip.values)
                                          .view({1, refine::kStations, weights::kRefineInputs}))[0]
                            .contiguous();
  auto engine = refine::Network::create(exported(network, "test"),
                                        [] { return reference::create_program(1); });
  ASSERT_TRUE(engine) << engine.error().message;
  const auto offsets = engine->see(sample.strip);
  ASSERT_TRUE(offsets) << offsets.error().message;
  const auto values = expected.accessor<float, 2>();
  double largest = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto i = static_cast<std::int64_t>(node);
    EXPECT_NEAR((*offsets)[node].deep, values[i][0], 1e-4F);
    EXPECT_NEAR((*offsets)[node].aside, values[i][1], 1e-4F);
    largest = std::max(largest, std::abs(static_cast<double>(values[i][0])));
  }
  EXPECT_GT(largest, 0.01);
}

TEST(Refining, LearnsWhatItsStripsShow) {
  const Recipe recipe = short_recipe(60);
  const auto samples = strips(25);
  const auto trained = train(recipe, samples, torch::kCPU, {});
  ASSERT_TRUE(trained) << trained.error().message;
  const torch::NoGradGuard no_gradients;
  double before = 0;
  double after = 0;
  auto network = trained->network;
  const auto& held_out = samples[0];  // as the first five of each twenty-five are
  const auto said = network
                        ->forward(torch::tensor(held_out.strip.values)
                                      .view({1, refine::kStations, weights::kRefineInputs}))[0]
                        .contiguous();
  for (std::size_t node = 0; node < kNodes; ++node) {
    const float deep = held_out.truth.deep[node];
    before += static_cast<double>(std::abs(deep));
    after += std::abs(static_cast<double>(deep) -
                      said[static_cast<std::int64_t>(node)][0].item<double>());
  }
  EXPECT_LT(after, 0.5 * before);
  EXPECT_NE(trained->table.find("| model of the noise | 5 |"), std::string::npos) << trained->table;
}

/// Strips of ropes that are read anywhere and lie on their table in every other scene, as the
/// columns of the table say.
std::vector<StripSample> laid_strips(int count) {
  std::mt19937 random(6);
  std::normal_distribution<float> value(0, 3);
  std::vector<StripSample> samples = strips(count);
  for (StripSample& sample : samples) {
    const bool laid = sample.truth.scene % 2 == 0;
    for (std::size_t node = 0; node < kNodes; ++node) {
      sample.to_table[node] = value(random);
      sample.truth.deep[node] = laid ? sample.to_table[node] : 0;
    }
    for (std::size_t station = 0; station < refine::kStations; ++station) {
      auto* const row = sample.strip.values.data() + station * weights::kRefineInputs;
      std::fill(row, row + refine::kAcross, 0.0F);
      for (int k = refine::kTableSeen; k <= refine::kTableSpread; ++k) row[k] = laid ? 2.0F : -2.0F;
    }
  }
  return samples;
}

TEST(Refining, LearnsWhichRopesLieOnTheirTable) {
  Recipe recipe = short_recipe(120);
  recipe.schedule.rate = 0.004;
  const auto samples = laid_strips(25);
  const auto trained = train(recipe, samples, torch::kCPU, {});
  ASSERT_TRUE(trained) << trained.error().message;
  auto engine = refine::Network::create(exported(trained->network, "test"),
                                        [] { return reference::create_program(1); });
  ASSERT_TRUE(engine) << engine.error().message;
  for (const std::size_t scene : {0, 1, 2, 3, 4}) {  // held out
    const auto offsets = engine->see(samples[scene].strip);
    ASSERT_TRUE(offsets) << offsets.error().message;
    double laid = 0;
    for (const auto& offset : *offsets) laid += static_cast<double>(offset.laid) / kNodes;
    if (scene % 2 == 0) {
      EXPECT_GT(laid, 0.7) << scene;
    } else {
      EXPECT_LT(laid, 0.3) << scene;
    }
  }
}

TEST(Refining, AnUnevenSceneMovesRopeAndDepthAlike) {
  const auto scene =
      synth::make_frame(synth::Split::kWide, synth::Part::kTraining, 0, 3500003, {.color = false});
  ASSERT_TRUE(scene) << scene.error().message;
  auto wavy = *scene;
  make_uneven(7, wavy);
  double most_m = 0;
  const auto& camera = scene->folder.intrinsics;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Point3& before = scene->truth()[i];
    const Point3& after = wavy.truth()[i];
    const auto px = geometry::project(camera, before);
    EXPECT_LT((geometry::project(camera, after) - px).norm(), 1e-2F);  // along its ray
    const auto u = static_cast<int>(std::lround(px.x()));
    const auto v = static_cast<int>(std::lround(px.y()));
    if (u < 0 || v < 0 || u >= scene->folder.width || v >= scene->folder.height) continue;
    const auto pixel = static_cast<std::size_t>(v * scene->folder.width + u);
    const float moved_m = wavy.folder.depth_m[pixel] - scene->folder.depth_m[pixel];
    if (scene->folder.depth_m[pixel] > 0) {
      EXPECT_NEAR(moved_m, after.z - before.z, 1e-3F);
    }
    most_m = std::max(most_m, std::abs(static_cast<double>(after.z - before.z)));
  }
  EXPECT_GT(most_m, 5e-4);
  auto again = *scene;
  make_uneven(7, again);
  EXPECT_EQ(again.folder.depth_m, wavy.folder.depth_m);
}

TEST(Refining, TooFewStripsAreRefused) {
  Recipe recipe;
  const auto trained = train(recipe, strips(5), torch::kCPU, {});
  ASSERT_FALSE(trained);
  EXPECT_EQ(trained.error().code, ErrorCode::kBadInput);
  EXPECT_NE(trained.error().message.find("data.scenes"), std::string::npos);
}

TEST(Refining, StripsComeBackAndAShortShardIsRefused) {
  const test::TemporaryFolder folder;
  const auto field =
      std::make_shared<const weights::FieldWeights>(weights::seeded_field({16, 32, 48}, 5));
  int scenes = 0;
  const auto made = make_strips(folder.path(), {.first = 3500000, .scenes = 1, .seen = 0}, field, 2,
                                [&] { ++scenes; });
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(scenes, kShardScenes);
  const auto samples = read_strips(folder.path());
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_GT(samples->size(), kShardScenes / 2);
  for (const StripSample& sample : *samples) {
    EXPECT_GT(sample.truth.radius_m, 0);
    for (const float value : sample.strip.values) ASSERT_TRUE(std::isfinite(value));
    for (const float value : sample.truth.deep) ASSERT_TRUE(std::isfinite(value));
  }
  const auto file = folder.path() / "strips_00000.bin";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  const auto refused = read_strips(folder.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("remove the file"), std::string::npos);
}

TEST(Refining, TheShippedRecipeIsReadAndAnUnknownKeyIsRefused) {
  EXPECT_TRUE(read_recipe(test::source_dir() / "lab/train/recipes/refine.json"));
  const auto refused = parse_recipe(R"({"name": "x", "data": {"scenez": 3}})", "test");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("data.scenez"), std::string::npos);
}

}  // namespace
}  // namespace flowdlo::refining
