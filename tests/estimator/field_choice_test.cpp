// Which weights of a strand field an estimator takes, and what it says of those that do not fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "../frame/temporary_folder.hpp"
#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "scene/scene.hpp"
#include "support/rose_frame.hpp"
#include "support/wave_frame.hpp"
#include "weights/field_weights.hpp"
#include "weights/location.hpp"

namespace flowdlo {
namespace {

constexpr float kHalfWidth_m = 0.006F;  // of the drawn rope

namespace fs = std::filesystem;

Config small(const fs::path& weights) {
  return {.weights = weights, .device = "cpu", .euler_steps = 1, .draws = 1, .threads = 1};
}

TEST(FieldChoice, ItsWeightsLieBesideTheModels) {
  EXPECT_EQ(weights::located(FLOWDLO_DEFAULT_WEIGHTS).field.file,
            fs::path(FLOWDLO_DEFAULT_WEIGHTS).parent_path() / "field.safetensors");
  EXPECT_TRUE(weights::located(FLOWDLO_WEIGHTS).field.file.empty());
  EXPECT_TRUE(Estimator::create(small(FLOWDLO_DEFAULT_WEIGHTS)));
  EXPECT_TRUE(Estimator::create(small(FLOWDLO_WEIGHTS)));
}

TEST(FieldChoice, WeightsThatAreNamedHaveToBeThere) {
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  config.field_weights = "/nowhere/field.safetensors";
  const auto made = Estimator::create(config);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kIo);
  EXPECT_NE(made.error().message.find("/nowhere/field.safetensors"), std::string::npos);
}

TEST(FieldChoice, WeightsThatAreNoneAreRefusedUnlessTheFieldIsOff) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "field.safetensors";
  std::ofstream(file) << "no weights at all";
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  config.field_weights = file;
  const auto made = Estimator::create(config);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kBadWeights);
  config.field = FieldChoice::kOff;
  EXPECT_TRUE(Estimator::create(config));
}

/// Its ends are a rope's, not those of what an occluder leaves.
testing::WaveFrame clear_wave() { return testing::WaveFrame(320, 240, 9.0F, true); }

TEST(FieldChoice, AClearFrameIsReadOnceWithItAndHasTheSameNodesWithoutIt) {
  const testing::WaveFrame wave = clear_wave();
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  config.field = FieldChoice::kStrands;
  auto with = Estimator::create(config);
  config.field = FieldChoice::kOff;
  auto without = Estimator::create(config);
  ASSERT_TRUE(with && without);
  const auto a = with->estimate(wave.frame());
  const auto b = without->estimate(wave.frame());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->readings, 1);
  EXPECT_EQ(b->readings, 1);
  EXPECT_GT(a->confidence, 0.9F);
  EXPECT_GT(b->confidence, 0.9F);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR(a->nodes[i].x, b->nodes[i].x, kHalfWidth_m);
    EXPECT_NEAR(a->nodes[i].z, b->nodes[i].z, 0.001F);
  }
}

TEST(FieldChoice, StrandsThatTheMaskMergesAreToldApartWithIt) {
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  config.quality = Quality::kFast;
  auto estimator = Estimator::create(config);
  ASSERT_TRUE(estimator);
  const auto coil = lab::Kind::kCoil;
  const auto touching = lab::Kind::kTouching;
  for (const auto& [kind, seed] : std::vector<std::pair<lab::Kind, std::uint64_t>>{
           // The mask alone is wrong in each of the coils.
           {coil, 1000},
           {coil, 1007},
           {coil, 1010},
           {coil, 1014},
           {touching, 1000},
           {touching, 1001},
           {touching, 1002},
           {touching, 1003}}) {
    const lab::Scene scene = lab::make_scene(kind, seed);
    const auto estimate = estimator->estimate(scene.frame());
    ASSERT_TRUE(estimate) << seed;
    Centerline backwards = scene.truth;
    std::reverse(backwards.begin(), backwards.end());
    EXPECT_LT(std::min(geometry::mean_distance(estimate->nodes, scene.truth),
                       geometry::mean_distance(estimate->nodes, backwards)),
              0.005)
        << seed;
  }
}

TEST(FieldChoice, WithQualityFastTheModelIsAskedWithoutAFieldAlone) {
  const testing::WaveFrame clear = clear_wave();
  const testing::RoseFrame doubtful;
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  auto full = Estimator::create(config);
  config.quality = Quality::kFast;
  auto fast = Estimator::create(config);
  config.field = FieldChoice::kOff;
  auto masked = Estimator::create(config);
  ASSERT_TRUE(full && fast && masked);
  for (const Frame& frame : {clear.frame(), doubtful.frame()}) {
    const auto quick = fast->estimate(frame);
    const auto whole = full->estimate(frame);
    const auto alone = masked->estimate(frame);
    ASSERT_TRUE(quick && whole && alone);
    EXPECT_TRUE(quick->draws.empty());
    EXPECT_TRUE(quick->left_out.empty()) << "it was not left out for want of time";
    EXPECT_EQ(quick->timings.model_ms, 0);
    EXPECT_FALSE(whole->draws.empty());
    EXPECT_EQ(quick->nodes, whole->nodes) << "whether draws are made changes nothing else";
    EXPECT_FALSE(alone->draws.empty());
  }
  const auto sure = fast->estimate(clear.frame());
  const auto unsure = fast->estimate(doubtful.frame());
  ASSERT_TRUE(sure && unsure);
  EXPECT_GE(sure->confidence, 0.95F);
  EXPECT_EQ(sure->readings, 1);
  EXPECT_GT(unsure->readings, 1);
}

TEST(FieldChoice, TheNetworkThatRefinesMovesNodesByMillimetresAndChoosesAsBefore) {
  const testing::WaveFrame wave;
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  auto with = Estimator::create(config);
  config.field = FieldChoice::kStrands;
  auto without = Estimator::create(config);
  ASSERT_TRUE(with && without);
  const auto a = with->estimate(wave.frame());
  const auto b = without->estimate(wave.frame());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->origin, b->origin);
  EXPECT_EQ(a->sigma_m, b->sigma_m);
  float farthest_m = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    farthest_m = std::max(farthest_m,
                          std::hypot(a->nodes[i].x - b->nodes[i].x, a->nodes[i].y - b->nodes[i].y,
                                     a->nodes[i].z - b->nodes[i].z));
  }
  EXPECT_GT(farthest_m, 0);
  EXPECT_LT(farthest_m, 0.01F);
}

TEST(FieldChoice, AFileWithoutTheNetworkThatRefinesLeavesTheNodes) {
  const test::TemporaryFolder folder;
  auto weights =
      weights::load_field(fs::path(FLOWDLO_DEFAULT_WEIGHTS).parent_path() / "field.safetensors");
  ASSERT_TRUE(weights);
  weights->refine.reset();
  Config config = small(FLOWDLO_DEFAULT_WEIGHTS);
  config.field_weights = folder.path() / "field.safetensors";
  ASSERT_TRUE(weights::save_field(*weights, config.field_weights));
  auto without = Estimator::create(config);
  config.field = FieldChoice::kStrands;
  auto strands = Estimator::create(config);
  ASSERT_TRUE(without && strands);
  const testing::WaveFrame wave;
  const auto a = without->estimate(wave.frame());
  const auto b = strands->estimate(wave.frame());
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_EQ(a->nodes[i].x, b->nodes[i].x);
    EXPECT_EQ(a->nodes[i].z, b->nodes[i].z);
  }
}

}  // namespace
}  // namespace flowdlo
