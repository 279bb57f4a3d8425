#include "weights/safetensors.hpp"

#include <gmock/gmock.h>

#include <cstring>

namespace flowdlo::weights {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A file with this header and `data_bytes` zeros.
std::string file_of(const std::string& header, std::size_t data_bytes) {
  const std::uint64_t length = header.size();
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &length, 8);
  return bytes + header + std::string(data_bytes, '\0');
}

std::vector<std::string> faults_of(const std::string& bytes) {
  std::vector<std::string> list;
  static_cast<void>(
      parse_safetensors({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, list));
  return list;
}

std::vector<std::string> faults_of(const std::string& header, std::size_t data_bytes) {
  return faults_of(file_of(header, data_bytes));
}

TEST(Safetensors, HeaderReadsBack) {
  const std::vector<std::uint8_t> data(16);
  StoredTensor first{"a", {2, 2}, DType::kF16, "f16", {data.data(), 8}};
  StoredTensor second{"gamma", {}, DType::kF32, "f32", {data.data(), 4}};
  const auto header = safetensors_header({{"key", "value \"\xc3\xa9\""}}, {first, second});
  EXPECT_EQ(header.size() % 8, 0U);
  const std::string bytes = header + std::string(12, '\0');
  std::vector<std::string> list;
  const auto parsed =
      parse_safetensors({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, list);
  EXPECT_THAT(list, IsEmpty());
  EXPECT_EQ(parsed.metadata.at("key"), "value \"\xc3\xa9\"");
  ASSERT_EQ(parsed.tensors.size(), 2U);
  EXPECT_EQ(parsed.tensors[0].name, "a");
  EXPECT_THAT(parsed.tensors[0].shape, ElementsAre(2, 2));
  EXPECT_EQ(parsed.tensors[0].dtype, DType::kF16);
  EXPECT_EQ(parsed.tensors[0].bytes.size(), 8U);
  EXPECT_EQ(parsed.tensors[1].dtype, DType::kF32);
  EXPECT_THAT(parsed.tensors[1].shape, IsEmpty());
}

TEST(Safetensors, EmptyHeaderIsSound) { EXPECT_THAT(faults_of("{}", 0), IsEmpty()); }

TEST(Safetensors, FilesShorterThanTheirLengthFieldAreFaults) {
  for (std::size_t size = 0; size < 8; ++size) {
    EXPECT_THAT(faults_of(std::string(size, '\0')), ElementsAre(HasSubstr("header: ")));
  }
}

TEST(Safetensors, LengthBeyondTheFileIsAFault) {
  auto bytes = file_of("{}", 0);
  bytes[0] = 3;
  EXPECT_THAT(faults_of(bytes), ElementsAre(HasSubstr("got a length of 3")));
  std::fill_n(bytes.begin(), 8, '\xff');
  EXPECT_THAT(faults_of(bytes), ElementsAre(HasSubstr("18446744073709551615")));
}

TEST(Safetensors, HeaderThatIsNoObjectIsAFault) {
  for (const char* header : {"[]", "7", "nul", "{", "{\"a\":}", "{} {}", "\x93NUMPY"}) {
    EXPECT_THAT(faults_of(header, 0), ElementsAre(HasSubstr("expected a JSON object"))) << header;
  }
}

TEST(Safetensors, HeaderThatIsNoUtf8IsAFault) {
  EXPECT_THAT(faults_of("{\"\xff\":{}}", 0), ElementsAre(HasSubstr("expected a JSON object")));
}

TEST(Safetensors, DeepNestingIsAFault) {
  const std::string opened(400000, '[');
  const std::string closed(400000, ']');
  EXPECT_THAT(faults_of("{\"a\":" + opened + closed + "}", 0), ElementsAre(HasSubstr("nesting")));
  EXPECT_FALSE(faults_of("{\"a\":" + opened, 0).empty());
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_FALSE(faults_of(objects, 0).empty());
}

TEST(Safetensors, MetadataOfOtherThanStringsIsAFault) {
  EXPECT_THAT(faults_of(R"({"__metadata__":{"a":1,"b":"x","c":null}})", 0),
              ElementsAre(HasSubstr("metadata \"a\""), HasSubstr("metadata \"c\"")));
  EXPECT_THAT(faults_of(R"({"__metadata__":[]})", 0), ElementsAre(HasSubstr("__metadata__")));
}

TEST(Safetensors, TensorGivenTwiceIsAFault) {
  EXPECT_THAT(faults_of(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},)"
                        R"("a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})",
                        4),
              ElementsAre(AllOf(HasSubstr("\"a\""), HasSubstr("expected once"))));
}

TEST(Safetensors, EveryFaultOfATensorIsListed) {
  EXPECT_THAT(faults_of(R"({"a":{"dtype":1,"shape":[-1],"data_offsets":[0,5]},"b":3})", 4),
              ElementsAre(HasSubstr("dtype"), HasSubstr("shape"), HasSubstr("data_offsets"),
                          HasSubstr("\"b\": expected an object")));
}

TEST(Safetensors, OffsetsThatNoFileHasAreFaults) {
  for (const char* offsets :
       {"[4,0]", "[0,8]", "[18446744073709551615,18446744073709551615]", "[-1,4]", "[0,4,8]", "[0]",
        "[0.0,4.0]", R"(["0","4"])", "{}", "null", "[0,1e300]"}) {
    const auto header =
        std::string{R"({"a":{"dtype":"F32","shape":[1],"data_offsets":)"} + offsets + "}}";
    EXPECT_THAT(faults_of(header, 4), ElementsAre(HasSubstr("data_offsets"))) << offsets;
  }
}

TEST(Safetensors, ShapesThatNoTensorHasAreFaults) {
  for (const char* shape :
       {"[4294967296]", "[-1]", "[1.5]", R"(["1"])", "null", "{}", "18446744073709551615"}) {
    const auto header =
        std::string{R"({"a":{"dtype":"F32","shape":)"} + shape + R"(,"data_offsets":[0,4]}})";
    EXPECT_THAT(faults_of(header, 4), Contains(HasSubstr("shape"))) << shape;
  }
}

TEST(Safetensors, OverlapGapAndSurplusBytesAreFaults) {
  const auto two = [](const char* first, const char* second) {
    return std::string{R"({"a":{"dtype":"F32","shape":[1],"data_offsets":)"} + first +
           R"(},"b":{"dtype":"F32","shape":[1],"data_offsets":)" + second + "}}";
  };
  EXPECT_THAT(faults_of(two("[0,4]", "[4,8]"), 8), IsEmpty());
  EXPECT_THAT(faults_of(two("[4,8]", "[0,4]"), 8), IsEmpty());
  EXPECT_THAT(faults_of(two("[0,4]", "[2,6]"), 6), ElementsAre(HasSubstr("overlap")));
  EXPECT_THAT(faults_of(two("[0,4]", "[0,4]"), 4), ElementsAre(HasSubstr("overlap")));
  EXPECT_THAT(faults_of(two("[0,4]", "[6,10]"), 10), ElementsAre(HasSubstr("gap")));
  EXPECT_THAT(faults_of(two("[0,4]", "[4,8]"), 9), ElementsAre(HasSubstr("9 bytes of data")));
}

}  // namespace
}  // namespace flowdlo::weights
