#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <limits>

#include "raw_fdw.hpp"
#include "weights/weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

using test::WeightsFolder;
using testing::HasSubstr;

void expect_same_metadata(const Metadata& got, const Metadata& expected) {
  EXPECT_EQ(got.name, expected.name);
  EXPECT_EQ(got.version, expected.version);
  EXPECT_EQ(got.training_data, expected.training_data);
  EXPECT_EQ(got.licence, expected.licence);
  EXPECT_EQ(got.notes, expected.notes);
  EXPECT_EQ(got.mean, expected.mean);
  EXPECT_EQ(got.scale, expected.scale);
  EXPECT_EQ(got.trained, expected.trained);
  EXPECT_EQ(got.variant, expected.variant);
}

TEST(Save, F32RoundTripKeepsEveryBit) {
  const WeightsFolder folder;
  const auto weights = seeded({}, 2);
  ASSERT_TRUE(save(weights, folder / "model.fdw", StorageType::kF32));
  const auto loaded = load(folder / "model.fdw");
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (std::size_t i = 0; i < weights.tensors.size(); ++i) {
    ASSERT_EQ(loaded->tensors[i].name, weights.tensors[i].name);
    ASSERT_EQ(loaded->tensors[i].shape, weights.tensors[i].shape);
    ASSERT_EQ(loaded->tensors[i].values, weights.tensors[i].values);
  }
}

TEST(Save, F16RoundTripRoundsToNearest) {
  const WeightsFolder folder;
  const auto weights = seeded({}, 2);
  ASSERT_TRUE(save(weights, folder / "model.fdw"));
  const auto loaded = load(folder / "model.fdw");
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (std::size_t i = 0; i < weights.tensors.size(); ++i) {
    for (std::size_t k = 0; k < weights.tensors[i].values.size(); ++k) {
      const float expected = half_to_float(float_to_half(weights.tensors[i].values[k]));
      ASSERT_EQ(loaded->tensors[i].values[k], expected) << weights.tensors[i].name;
    }
  }
}

TEST(Save, EveryVariantAndFieldOfMetadataRoundTrips) {
  const WeightsFolder folder;
  const std::array variants{
      Variant{.parameterization = ops::Parameterization::kDirect, .local_channels = 8},
      Variant{.parameterization = ops::Parameterization::kPreconditioned,
              .visible_points = false,
              .head_channels = 4,
              .normalization = NormalizationKind::kFrame,
              .prior_kind = PriorKind::kRefined,
              .prior_sd = 0.3F}};
  for (const Variant& variant : variants) {
    auto weights = seeded(variant, 2);
    weights.metadata.name =
        "stra\xc3\x9f"
        "e";
    weights.metadata.notes = "two\nlines, \"quoted\"";
    weights.metadata.mean = {0.1F, -0.2F, 0.3F};
    weights.metadata.scale = 0.123456789F;
    weights.metadata.trained = true;
    ASSERT_TRUE(save(weights, folder / "model.fdw"));
    const auto loaded = load(folder / "model.fdw");
    ASSERT_TRUE(loaded) << loaded.error().message;
    expect_same_metadata(loaded->metadata, weights.metadata);
  }
}

TEST(Save, AlignsEveryTensorTo64Bytes) {
  const WeightsFolder folder;
  ASSERT_TRUE(save(seeded({}, 2), folder / "model.fdw"));
  const auto bytes = test::bytes_of(folder / "model.fdw");
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  for (const auto* tensor : *fdw::GetWeights(begin)->tensors()) {
    EXPECT_EQ((tensor->data()->data() - begin) % 64, 0) << tensor->name()->str();
  }
}

TEST(Save, SameWeightsGiveTheSameBytes) {
  const WeightsFolder folder;
  ASSERT_TRUE(save(seeded({}, 2), folder / "first.fdw"));
  ASSERT_TRUE(save(seeded({}, 2), folder / "second.fdw"));
  EXPECT_EQ(test::bytes_of(folder / "first.fdw"), test::bytes_of(folder / "second.fdw"));
}

TEST(Save, LeavesNothingButTheFile) {
  const WeightsFolder folder;
  ASSERT_TRUE(save(seeded({}, 2), folder / "model.fdw"));
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Save, ValueBeyondF16NamesTheTensorAndWritesNothing) {
  const WeightsFolder folder;
  auto weights = seeded({}, 2);
  weights.tensors[3].values[7] = 65520.0F;
  weights.tensors[4].values[0] = -1e9F;
  const auto saved = save(weights, folder / "model.fdw");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kBadWeights);
  EXPECT_THAT(saved.error().message, HasSubstr("\"" + weights.tensors[3].name + "\""));
  EXPECT_THAT(saved.error().message, HasSubstr("\"" + weights.tensors[4].name + "\""));
  EXPECT_EQ(folder.entries(), 0);
  EXPECT_TRUE(save(weights, folder / "model.fdw", StorageType::kF32));
}

TEST(Save, FaultyWeightsWriteNothing) {
  const WeightsFolder folder;
  auto weights = seeded({}, 2);
  weights.metadata.scale = std::numeric_limits<float>::infinity();
  weights.tensors[3].values[7] = std::nanf("");
  const auto saved = save(weights, folder / "model.fdw");
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().message, HasSubstr("metadata scale"));
  EXPECT_THAT(saved.error().message, HasSubstr("expected finite values"));
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Save, MissingFolderIsAnIoError) {
  const WeightsFolder folder;
  const auto saved = save(seeded({}, 2), folder / "none" / "model.fdw");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kIo);
  EXPECT_EQ(folder.entries(), 0);
}

TEST(Save, FolderInThePlaceOfTheFileLeavesNoTemporary) {
  const WeightsFolder folder;
  std::filesystem::create_directories(folder / "model.fdw" / "content");
  const auto saved = save(seeded({}, 2), folder / "model.fdw");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kIo);
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Save, FullDiskLeavesTheOldFileAndNoTemporary) {
  const WeightsFolder folder;
  test::write_bytes(folder / "model.fdw", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 20U, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto saved = save(seeded({}, 2), folder / "model.fdw");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, ErrorCode::kIo);
  EXPECT_EQ(test::bytes_of(folder / "model.fdw"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Save, ReplacesAnOlderFile) {
  const WeightsFolder folder;
  test::write_bytes(folder / "model.fdw", "old");
  ASSERT_TRUE(save(seeded({}, 2), folder / "model.fdw"));
  EXPECT_TRUE(load(folder / "model.fdw"));
}

}  // namespace
}  // namespace flowdlo::weights
