#include "survey/packed.hpp"

#include <gtest/gtest.h>

namespace flowdlo::survey {
namespace {

TEST(Packed, ValuesComeBackInTheirOrder) {
  Packer packer;
  packer.put(7);
  packer.put_all(std::vector<float>{1, 2, 3});
  packer.put_text("rope");
  Unpacker unpacker(packer.bytes);
  EXPECT_EQ(unpacker.get<int>(), 7);
  std::vector<float> values;
  unpacker.get_all(values);
  EXPECT_EQ(values, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(unpacker.get_text(), "rope");
  EXPECT_TRUE(unpacker.fine());
  EXPECT_TRUE(unpacker.at_end());
}

TEST(Packed, ACountBeyondTheEndReadsNothing) {
  Packer packer;
  packer.put(std::uint64_t{1} << 60U);
  Unpacker unpacker(packer.bytes);
  std::vector<double> values;
  unpacker.get_all(values);
  EXPECT_FALSE(unpacker.fine());
  EXPECT_TRUE(values.empty());
}

}  // namespace
}  // namespace flowdlo::survey
