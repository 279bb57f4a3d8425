#include "npy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <string>

namespace flowdlo::tools {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::size_t header_length(const std::string& bytes) {
  return 10 + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
}

TEST(Npy, HasTheMagicOfVersionOneAndAHeaderOfWholeSixtyFourBytes) {
  const auto bytes = npy_f32(std::vector<float>(6, 0.5F), {2, 3});
  EXPECT_THAT(bytes, StartsWith(std::string("\x93NUMPY\x01\x00", 8)));
  EXPECT_EQ(header_length(bytes) % 64, 0U);
  EXPECT_EQ(bytes[header_length(bytes) - 1], '\n');
}

TEST(Npy, StatesTypeOrderAndShapeAsNumpyDoes) {
  EXPECT_THAT(npy_f32(std::vector<float>(6), {2, 3}),
              HasSubstr("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"));
  EXPECT_THAT(npy_bool(std::vector<std::uint8_t>(5), {5}),
              HasSubstr("{'descr': '|b1', 'fortran_order': False, 'shape': (5,), }"));
  EXPECT_THAT(npy_u8(std::vector<std::uint8_t>(8), {2, 2, 2}), HasSubstr("'|u1'"));
}

TEST(Npy, ValuesFollowTheHeaderAsTheyLie) {
  const std::vector<float> values = {1.5F, -2.0F, 0.25F};
  const auto bytes = npy_f32(values, {3});
  ASSERT_EQ(bytes.size(), header_length(bytes) + 12);
  EXPECT_EQ(std::memcmp(bytes.data() + header_length(bytes), values.data(), 12), 0);
}

TEST(Npy, ArrayOfNothingIsAHeaderAlone) {
  const auto bytes = npy_f32({}, {0, 2});
  EXPECT_EQ(bytes.size(), header_length(bytes));
  EXPECT_THAT(bytes, HasSubstr("(0, 2)"));
}

}  // namespace
}  // namespace flowdlo::tools
