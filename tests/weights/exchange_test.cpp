#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "flowdlo/weights.hpp"
#include "random/philox.hpp"
#include "weights/weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo {
namespace {

using test::WeightsFolder;
using testing::AllOf;
using testing::HasSubstr;
using weights::StorageType;

const weights::Variant kVariant{.parameterization = ops::Parameterization::kPreconditioned,
                                .local_channels = 8,
                                .head_channels = 4,
                                .normalization = weights::NormalizationKind::kFrame,
                                .prior_kind = weights::PriorKind::kRefined,
                                .prior_sd = 0.25F};

/// Header and data of a .safetensors file, to be changed and put together again.
struct Parts {
  nlohmann::ordered_json header;
  std::string data;

  explicit Parts(const std::string& bytes) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), 8);
    header = nlohmann::ordered_json::parse(bytes.substr(8, length));
    data = bytes.substr(8 + length);
  }

  [[nodiscard]] std::string bytes() const {
    const std::string text = header.dump();
    const std::uint64_t length = text.size();
    std::string result(8, '\0');
    std::memcpy(result.data(), &length, 8);
    return result + text + data;
  }
};

class Exchange : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(weights::save(weights::seeded(kVariant, 4), fdw_));
    ASSERT_TRUE(export_safetensors(fdw_, safetensors_));
  }

  /// The error of importing `parts`, or "" when it works.
  [[nodiscard]] std::string import_error(const Parts& parts) const {
    test::write_bytes(safetensors_, parts.bytes());
    std::filesystem::remove(back_);
    const auto imported = import_safetensors(safetensors_, back_);
    if (imported) return {};
    EXPECT_EQ(imported.error().code, ErrorCode::kBadWeights);
    EXPECT_FALSE(std::filesystem::exists(back_));
    return imported.error().message;
  }

  WeightsFolder folder_;
  std::filesystem::path fdw_ = folder_ / "model.fdw";
  std::filesystem::path safetensors_ = folder_ / "model.safetensors";
  std::filesystem::path back_ = folder_ / "back.fdw";
};

TEST_F(Exchange, ThereAndBackGivesTheSameFile) {
  ASSERT_TRUE(import_safetensors(safetensors_, back_));
  EXPECT_EQ(test::bytes_of(back_), test::bytes_of(fdw_));
}

TEST_F(Exchange, F32ThereAndBackGivesTheSameFile) {
  ASSERT_TRUE(weights::save(weights::seeded({}, 4), fdw_, StorageType::kF32));
  ASSERT_TRUE(export_safetensors(fdw_, safetensors_));
  ASSERT_TRUE(import_safetensors(safetensors_, back_));
  EXPECT_EQ(test::bytes_of(back_), test::bytes_of(fdw_));
}

TEST_F(Exchange, HeaderHoldsNamesShapesAndMetadata) {
  const Parts parts(test::bytes_of(safetensors_));
  EXPECT_EQ(parts.header["head.weight"]["dtype"], "F16");
  EXPECT_EQ(parts.header["head.weight"]["shape"], (std::vector{4, 256}));
  EXPECT_EQ(parts.header["gamma"]["shape"], nlohmann::ordered_json::array());
  const auto& metadata = parts.header["__metadata__"];
  EXPECT_EQ(metadata["parameterization"], "preconditioned");
  EXPECT_EQ(metadata["local_channels"], "8");
  EXPECT_EQ(metadata["prior_sd"], "0.25");
  EXPECT_EQ(metadata["sha256"].get<std::string>().size(), 64U);
}

TEST_F(Exchange, Bf16IsReadAsTheValuesItHolds) {
  Parts parts(test::bytes_of(safetensors_));
  parts.header["__metadata__"].erase("sha256");
  parts.header["norm.weight"]["dtype"] = "BF16";
  const std::size_t begin = parts.header["norm.weight"]["data_offsets"][0];
  for (std::size_t i = 0; i < 256; ++i) {
    parts.data[begin + 2 * i] = '\x40';
    parts.data[begin + 2 * i + 1] = '\xc0';  // 0xc040: -3
  }
  ASSERT_EQ(import_error(parts), "");
  const auto loaded = weights::load(back_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->at("norm.weight").values, std::vector<float>(256, -3.0F));
}

TEST_F(Exchange, KeysOfOtherProgramsAreLeftAlone) {
  Parts parts(test::bytes_of(safetensors_));
  parts.header["__metadata__"]["format"] = "pt";
  EXPECT_EQ(import_error(parts), "");
}

TEST_F(Exchange, ImportListsEveryMismatch) {
  Parts parts(test::bytes_of(safetensors_));
  auto entry = parts.header["state.weight"];
  parts.header.erase("state.weight");
  parts.header["stage.weight"] = entry;
  parts.header["node"]["shape"] = {256, 64};
  parts.header["norm.bias"]["dtype"] = "I64";
  parts.header["__metadata__"].erase("mean");
  parts.header["__metadata__"]["scale"] = "inf";
  parts.header["__metadata__"]["normalization"] = "none";
  EXPECT_THAT(import_error(parts),
              AllOf(HasSubstr("\"state.weight\": expected [256, 3] f32, f16 or bf16, got none"),
                    HasSubstr("\"stage.weight\": expected no tensor"),
                    HasSubstr("\"node\": expected [64, 256] f32, f16 or bf16, got [256, 64] f16"),
                    HasSubstr("\"norm.bias\": expected [256] f32, f16 or bf16, got [256] \"I64\""),
                    HasSubstr("metadata mean: "), HasSubstr("metadata scale: "),
                    HasSubstr("metadata normalization: ")));
}

TEST_F(Exchange, SizeThatDisagreesWithTheDtypeIsAnError) {
  Parts parts(test::bytes_of(safetensors_));
  parts.header["norm.bias"]["dtype"] = "F32";
  EXPECT_THAT(import_error(parts), HasSubstr("\"norm.bias\": expected 1024 bytes"));
}

TEST_F(Exchange, NotANumberIsAnError) {
  Parts parts(test::bytes_of(safetensors_));
  const std::size_t begin = parts.header["gamma"]["data_offsets"][0];
  parts.data[begin + 1] = '\x7e';
  EXPECT_THAT(import_error(parts), HasSubstr("\"gamma\": expected finite values"));
}

TEST_F(Exchange, ChangedTensorUnderTheOldDigestIsAnError) {
  Parts parts(test::bytes_of(safetensors_));
  parts.data[1000] = static_cast<char>(parts.data[1000] ^ 1);
  EXPECT_THAT(import_error(parts), HasSubstr("leave the metadata key sha256 out"));
  parts.header["__metadata__"].erase("sha256");
  EXPECT_EQ(import_error(parts), "");
}

TEST_F(Exchange, TruncatedImportIsAnErrorAndLeavesNoFile) {
  const auto bytes = test::bytes_of(safetensors_);
  for (std::size_t i = 0; i < 50; ++i) {
    std::filesystem::resize_file(safetensors_, bytes.size() * (49 - i) / 50);
    ASSERT_FALSE(import_safetensors(safetensors_, back_)) << i;
    ASSERT_EQ(folder_.entries(), 2);
  }
}

TEST_F(Exchange, FlippedBitsInTheHeaderNeverCrashTheImport) {
  constexpr std::uint64_t kFlips = 300;
  const auto bytes = test::bytes_of(safetensors_);
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), 8);
  const auto flip = [this](std::size_t position, char value) {
    std::fstream stream(safetensors_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(static_cast<std::streamoff>(position));
    stream.put(value);
  };
  int errors = 0;
  for (std::uint64_t i = 0; i < kFlips; ++i) {
    const auto words = random::philox(8, i);
    const std::size_t position = words[0] % (8 + length);
    const auto bit = 1U << words[1] % 8;
    flip(position, static_cast<char>(static_cast<unsigned char>(bytes[position]) ^ bit));
    errors += import_safetensors(safetensors_, back_) ? 0 : 1;
    flip(position, bytes[position]);
  }
  EXPECT_GT(errors, 100);
}

TEST_F(Exchange, MissingInputsAreIoErrors) {
  const auto exported = export_safetensors(folder_ / "none.fdw", folder_ / "out");
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, ErrorCode::kIo);
  const auto imported = import_safetensors(folder_ / "none.safetensors", folder_ / "out");
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, ErrorCode::kIo);
  EXPECT_EQ(folder_.entries(), 2);
}

TEST_F(Exchange, UnwritableOutputsAreIoErrors) {
  const auto exported = export_safetensors(fdw_, folder_ / "none" / "out.safetensors");
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, ErrorCode::kIo);
  const auto imported = import_safetensors(safetensors_, folder_ / "none" / "out.fdw");
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, ErrorCode::kIo);
  EXPECT_EQ(folder_.entries(), 2);
}

TEST_F(Exchange, WeightsFileGivenAsSafetensorsIsAnError) {
  const auto imported = import_safetensors(fdw_, back_);
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, ErrorCode::kBadWeights);
}

}  // namespace
}  // namespace flowdlo
