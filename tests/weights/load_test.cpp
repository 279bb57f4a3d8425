#include <gmock/gmock.h>
#include <sys/stat.h>

#include "raw_fdw.hpp"
#include "weights/weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

using test::RawFdw;
using test::WeightsFolder;
using testing::AllOf;
using testing::HasSubstr;

/// The error that `raw` gives, or "" when it loads.
std::string message_of(const RawFdw& raw) {
  const WeightsFolder folder;
  test::write_bytes(folder / "raw.fdw", raw.bytes());
  const auto loaded = load(folder / "raw.fdw");
  if (loaded) return {};
  EXPECT_EQ(loaded.error().code, ErrorCode::kBadWeights);
  return loaded.error().message;
}

std::ptrdiff_t lines(const std::string& text) {
  return 1 + std::count(text.begin(), text.end(), '\n');
}

TEST(Load, TakesWhatTheSchemaDescribes) { EXPECT_EQ(message_of(RawFdw{}), ""); }

TEST(Load, TakesTensorsInAnyOrderOfTheFileButDigestsInTheManifests) {
  RawFdw raw;
  std::swap(raw.tensors[0], raw.tensors[1]);
  EXPECT_THAT(message_of(raw), AllOf(HasSubstr("SHA-256"), testing::Not(HasSubstr("\n"))));
}

TEST(Load, TakesAScalarOfOneElement) {
  RawFdw raw;
  raw.at("gamma").shape = {1};
  EXPECT_EQ(message_of(raw), "");
}

TEST(Load, NamesTheTensorOfAnotherShape) {
  RawFdw raw;
  raw.at("encoder.3.up.weight").shape = {512, 256};
  raw.at("encoder.3.up.weight").data.resize(512 * 256 * 2);
  EXPECT_THAT(message_of(raw),
              testing::EndsWith("raw.fdw: tensor \"encoder.3.up.weight\": expected [1024, 256] f32 "
                                "or f16, got [512, 256] f16; re-export with the manifest in "
                                "weights/README.md"));
}

TEST(Load, ListsEveryMismatchAtOnce) {
  RawFdw raw;
  raw.metadata.scale = 0;
  raw.metadata.prior_sd = -1;
  raw.metadata.local_features_version = 99;
  raw.metadata.parameterization = static_cast<fdw::Parameterization>(77);
  raw.metadata.normalization = fdw::Normalization::unset;
  raw.metadata.trained = static_cast<fdw::Switch>(3);
  raw.at("state.weight").name = "stage.weight";
  raw.at("node").shape = {256, 64};
  raw.at("gamma").dtype = static_cast<fdw::DType>(7);
  raw.at("time.0.bias").data.pop_back();
  raw.at("time.2.bias").data[1] = 0x7C;  // with the other byte: infinity or NaN
  raw.tensors.push_back(raw.at("norm.bias"));
  const auto message = message_of(raw);
  for (const char* part :
       {"metadata scale: ", "metadata prior_sd: ", "metadata local_features_version: ",
        "metadata parameterization: ", "metadata normalization: ", "metadata trained: ",
        "tensor \"state.weight\": expected [256, 3] f32 or f16, got none",
        "tensor \"stage.weight\": expected no tensor of that name",
        "tensor \"node\": expected [64, 256] f32 or f16, got [256, 64] f16",
        "tensor \"gamma\": expected [] f32 or f16, got [] dtype 7",
        "tensor \"time.0.bias\": expected 512 bytes for [256] f16, got 511",
        "tensor \"time.2.bias\": expected finite values, got 1",
        "tensor \"norm.bias\": expected once"}) {
    EXPECT_THAT(message, HasSubstr(part));
  }
  EXPECT_EQ(lines(message), 13) << message;
}

TEST(Load, RefusesChannelsThatNoVariantHas) {
  RawFdw raw;
  raw.metadata.local_channels = -2147483647 - 1;
  raw.metadata.head_channels = 2147483647;
  EXPECT_THAT(message_of(raw), AllOf(HasSubstr("local_channels: expected 6 or 8"),
                                     HasSubstr("head_channels: expected 3 or 4")));
}

TEST(Load, RefusesTensorsOfAnotherVariant) {
  RawFdw raw;
  raw.metadata.visible_points = fdw::Switch::off;
  raw.metadata.local_channels = 8;
  EXPECT_THAT(message_of(raw), AllOf(HasSubstr("\"points.0.weight\": expected no tensor"),
                                     HasSubstr("\"cross.kv.bias\": expected no tensor"),
                                     HasSubstr("\"local.0.weight\": expected [256, 8]")));
}

TEST(Load, RefusesShapesWhoseProductOverflows) {
  RawFdw raw;
  raw.at("node").shape = {65536, 65536, 65536, 65536};
  raw.at("gamma").shape = {-1, -1};
  raw.at("norm.bias").shape = std::vector<int>(1000, 1 << 30);
  EXPECT_THAT(message_of(raw), AllOf(HasSubstr("got [65536, 65536, 65536, 65536]"),
                                     HasSubstr("got [-1, -1]"), HasSubstr(", ...]")));
}

TEST(Load, RefusesMoreTensorsThanAnyModelHas) {
  RawFdw raw;
  for (int i = 0; i < 5000; ++i) raw.tensors.push_back({std::to_string(i), {}, {}, {}});
  EXPECT_THAT(message_of(raw), HasSubstr("expected an intact FlatBuffer"));
}

TEST(Load, RefusesTensorsThatShareOneHugeShapeAndName) {
  constexpr int kTensors = 900;
  flatbuffers::FlatBufferBuilder builder;
  const auto name = builder.CreateString(std::string(8U << 20U, 'n'));
  const auto shape = builder.CreateVector(std::vector<int>(4U << 20U, 1));
  builder.ForceVectorAlignment(1, 1, 64);
  const auto data = builder.CreateVector(std::vector<std::uint8_t>{0});
  std::vector<flatbuffers::Offset<fdw::Tensor>> tensors;
  for (int i = 0; i < kTensors; ++i) {
    tensors.push_back(fdw::CreateTensor(builder, name, shape, fdw::DType::f16, data));
  }
  const fdw::Mean mean(0, 0, 0);
  const auto text = builder.CreateString("none");
  fdw::MetadataBuilder metadata(builder);
  metadata.add_name(text);
  metadata.add_version(text);
  metadata.add_training_data(text);
  metadata.add_licence(text);
  metadata.add_notes(text);
  metadata.add_mean(&mean);
  metadata.add_sha256(text);
  const auto fields = metadata.Finish();
  const auto list = builder.CreateVector(tensors);
  fdw::FinishWeightsBuffer(builder, fdw::CreateWeights(builder, fields, list));
  const WeightsFolder folder;
  test::write_bytes(folder / "shared.fdw",
                    {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()});
  const auto loaded = load(folder / "shared.fdw");
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("expected once, got it again"));
  EXPECT_THAT(loaded.error().message, HasSubstr("metadata scale"));
}

TEST(Load, PrintsHostileNamesHarmlessly) {
  RawFdw raw;
  raw.tensors.push_back({"\x1b[2J\xff\n" + std::string(100000, 'n'), {}, {}, {}});
  const auto message = message_of(raw);
  EXPECT_LT(message.size(), 500U);
  EXPECT_EQ(lines(message), 1);
  EXPECT_THAT(message, HasSubstr("\"?[2J??nnn"));
}

TEST(Load, RefusesMetadataThatIsNoUtf8) {
  RawFdw raw;
  raw.metadata.name = "caf\xe9";
  EXPECT_THAT(message_of(raw), HasSubstr("metadata name: expected UTF-8"));
}

TEST(Load, RefusesAnotherIdentifier) {
  const WeightsFolder folder;
  test::write_bytes(folder / "swapped.fdw", RawFdw{}.bytes("FDW2"));
  const auto loaded = load(folder / "swapped.fdw");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kBadWeights);
  EXPECT_THAT(loaded.error().message, HasSubstr("identifier \"FDW1\", got \"FDW2\""));
}

TEST(Load, MissingFileIsAnIoError) {
  const auto loaded = load("no/such/file.fdw");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kIo);
  EXPECT_THAT(loaded.error().message, HasSubstr("no/such/file.fdw: "));
}

TEST(Load, FolderIsAnIoError) {
  const WeightsFolder folder;
  const auto loaded = load(folder.path());
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kIo);
  EXPECT_THAT(loaded.error().message, HasSubstr("a folder"));
}

TEST(Load, PipeIsAnIoErrorAndNoWait) {
  const WeightsFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto loaded = load(folder / "pipe");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kIo);
}

TEST(Load, FileOfManyGigabytesIsRefusedUnread) {
  const WeightsFolder folder;
  test::write_bytes(folder / "huge.fdw", "x");
  std::filesystem::resize_file(folder / "huge.fdw", std::uintmax_t{1} << 40U);  // sparse
  const auto loaded = load(folder / "huge.fdw");
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("expected at most"));
}

}  // namespace
}  // namespace flowdlo::weights
