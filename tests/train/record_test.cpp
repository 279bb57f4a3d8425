// A record holds what the estimator feeds its model, bit for bit.
#include "train/record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "evidence/mask_field.hpp"
#include "flowdlo/estimator.hpp"
#include "reference/mask_features.hpp"
#include "support/program_cases.hpp"
#include "train/depth_dropout.hpp"
#include "train/record_file.hpp"
#include "train/record_folder.hpp"
#include "train/scene_source.hpp"
#include "train/sparse_field.hpp"

namespace flowdlo::train {
namespace {

constexpr RecordOptions kRefined{weights::PriorKind::kRefined, false};

OwnedFrame scene(std::uint64_t index, double depth_dropout = 0) {
  const auto source = scene_source({.maker = "sketch", .depth_dropout = depth_dropout});
  EXPECT_TRUE(source);
  auto frame = (*source)(Part::kTraining, index);
  EXPECT_TRUE(frame);
  return *std::move(frame);
}

/// A folder of this test's own, gone afterwards.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              (std::string("flowdlo_train_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(Record, HoldsWhatTheEstimatorFeedsItsModelBitForBit) {
  auto estimator = Estimator::create({.weights = FLOWDLO_WEIGHTS,
                                      .device = "cpu",
                                      .euler_steps = 1,
                                      .draws = 1,
                                      .prior = PriorChoice::kRefined,
                                      .threads = 1});
  ASSERT_TRUE(estimator) << estimator.error().message;
  for (const std::uint64_t index : {0, 3, 5, 8, 10}) {  // crossings, occluder, bad depth, coil
    const OwnedFrame owned = scene(index, /*depth_dropout=*/0.5);
    const auto record = make_record(owned.labelled, kRefined);
    Tensors fed;
    const auto estimate = estimator->estimate(owned.labelled.frame, fed);
    ASSERT_TRUE(record) << record.error().message;
    ASSERT_TRUE(estimate) << estimate.error().message;

    const PriorState& best = record->priors.front();
    EXPECT_EQ(std::memcmp(best.nodes.data(), fed.prior.data(), sizeof best.nodes), 0) << index;
    EXPECT_EQ(std::memcmp(best.support.data(), fed.support.data(), kNodes), 0) << index;
    EXPECT_EQ(std::memcmp(record->visible.points_cam.data(), fed.visible.data(),
                          sizeof record->visible.points_cam),
              0)
        << index;
    EXPECT_EQ(std::memcmp(record->visible.valid.data(), fed.visible_valid.data(), 256), 0) << index;
    EXPECT_EQ(record->priors.size(), 1 + estimate->alternatives.size()) << index;

    const auto mask = image_of(record->mask);
    const auto field =
        evidence::mask_field({record->mask.width, record->mask.height, {}, {}, mask, {}});
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const std::size_t count = field.texels.size() / 4;
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(field.texels[i * 4 + channel], fed.mask_field[channel * count + i]) << index;
      }
    }
  }
}

TEST(Record, FrameWithoutRopeHasNone) {
  OwnedFrame owned = scene(0);
  const std::vector<std::uint8_t> nothing(owned.labelled.frame.mask.size(), 0);
  owned.labelled.frame.mask = nothing;
  const auto record = make_record(owned.labelled, kRefined);
  ASSERT_FALSE(record);
  EXPECT_EQ(record.error().code, ErrorCode::kNoEvidence);
}

TEST(SparseField, EqualsTheEnginesMaskField) {
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{333, 241}}) {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(width) * height, 0);
    for (int u = 20; u < width - 40; ++u) {
      const int v = height / 2 + static_cast<int>(60 * std::sin(0.03 * u));
      for (int k = -4; k <= 4; ++k) mask[static_cast<std::size_t>((v + k) * width + u)] = 255;
    }
    const Frame frame{width, height, {}, {}, mask, {}};
    const auto field = evidence::mask_field(frame);
    SparseField sparse;
    sparse.reset(runs_of(frame));
    for (int row = 0; row < field.height; row += 7) {
      for (int column = 0; column < field.width; column += 5) {
        const auto got = sparse.texel(row, column);
        const float* want =
            field.texels.data() + 4 * (static_cast<std::size_t>(row) * field.width + column);
        ASSERT_EQ(got[0], want[0]);
        ASSERT_NEAR(got[1], want[1], 1e-6);
        ASSERT_EQ(got[2], want[2]);
        ASSERT_EQ(got[3], want[3]);
      }
    }
  }
}

TEST(SparseField, WithoutMaskIsFarEverywhere) {
  SparseField sparse;
  sparse.reset({64, 48, {}});
  const std::array<float, 4> far{0, 0, 32, 32};
  EXPECT_EQ(sparse.texel(3, 7), far);
}

TEST(DepthDropout, LosesDepthOnTheRopeAloneAndTheSameEveryTime) {
  const OwnedFrame owned = scene(0);
  const Frame& frame = owned.labelled.frame;
  const auto depth = with_depth_dropout(frame, owned.labelled.truth, 7);
  EXPECT_EQ(depth, with_depth_dropout(frame, owned.labelled.truth, 7));
  int lost = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] == frame.depth_m[i]) continue;
    ++lost;
    ASSERT_EQ(depth[i], 0);
    ASSERT_GT(frame.mask[i], 127);
  }
  EXPECT_GT(lost, 20);
}

TEST(RecordFolder, ShardsComeBackAndGrowWithoutBeingMadeAgain) {
  const Folder folder;
  const SourceConfig source{.maker = "sketch", .seed = 4};
  int made = 0;
  const auto make = [&](std::uint64_t scenes) {
    return make_records(folder.path(), Part::kTraining, scenes, source, kRefined, 2,
                        [&] { ++made; });
  };
  ASSERT_TRUE(make(kShardScenes));
  const auto first = load_records(folder.path(), Part::kTraining);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->records.size() + first->skipped, kShardScenes);
  ASSERT_TRUE(make(kShardScenes));
  EXPECT_EQ(made, static_cast<int>(kShardScenes));
  EXPECT_EQ(load_records(folder.path(), Part::kTraining)->sha256, first->sha256);
}

TEST(RecordFolder, RecordsOfAnotherOriginAreRefused) {
  const Folder folder;
  ASSERT_TRUE(
      make_records(folder.path(), Part::kTraining, 1, {.maker = "sketch"}, kRefined, 2, {}));
  const auto other = make_records(folder.path(), Part::kTraining, 1, {.maker = "sketch", .seed = 9},
                                  kRefined, 2, {});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("another folder"), std::string::npos);
}

TEST(RecordFolder, RecordsThatComeOutDifferentlyNowAreRefused) {
  const Folder folder;
  const SourceConfig source{.maker = "sketch", .seed = 6};
  ASSERT_TRUE(make_records(folder.path(), Part::kValidation, 1, source, kRefined, 2, {}));
  const auto file = folder.path() / "validation-00000.records";
  auto shard = read_shard(file);
  ASSERT_TRUE(shard);
  shard->records.front().priors.front().nodes[7].z += 1e-4F;  // as another engine might lift it
  ASSERT_TRUE(write_shard(*shard, file));
  const auto more = make_records(folder.path(), Part::kValidation, 200, source, kRefined, 2, {});
  ASSERT_FALSE(more);
  EXPECT_NE(more.error().message.find("have changed"), std::string::npos);
}

TEST(RecordFile, DamageIsNoticed) {
  const Folder folder;
  Shard shard;
  shard.records.push_back(*make_record(scene(0).labelled, kRefined));
  const auto file = folder.path() / "one.records";
  ASSERT_TRUE(write_shard(shard, file));
  ASSERT_TRUE(read_shard(file));
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(400);
  stream.put('\x7f');
  stream.close();
  const auto damaged = read_shard(file);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace flowdlo::train
