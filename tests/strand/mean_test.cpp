#include "strand/mean.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace flowdlo::strand {
namespace {

constexpr weights::FieldSizes kSizes{16, 16, 32};

weights::FieldWeights field_of(std::uint64_t seed, const std::string& notes) {
  auto field = weights::seeded_field(kSizes, seed);
  field.notes = notes;
  return field;
}

TEST(MeanOfFields, LiesHalfWayBetweenTwo) {
  const std::vector fields{field_of(1, "first"), field_of(2, "second")};
  const auto mean = mean_of(fields);
  ASSERT_TRUE(mean) << mean.error().message;
  EXPECT_EQ(mean->sizes, kSizes);
  EXPECT_EQ(mean->notes, "mean of 2: [first] [second]");
  ASSERT_EQ(mean->tensors.size(), fields[0].tensors.size());
  for (std::size_t t = 0; t < mean->tensors.size(); ++t) {
    EXPECT_EQ(mean->tensors[t].name, fields[0].tensors[t].name);
    EXPECT_EQ(mean->tensors[t].shape, fields[0].tensors[t].shape);
    for (std::size_t i = 0; i < mean->tensors[t].values.size(); ++i) {
      EXPECT_NEAR(mean->tensors[t].values[i],
                  (fields[0].tensors[t].values[i] + fields[1].tensors[t].values[i]) / 2, 1e-6);
    }
  }
}

TEST(MeanOfFields, OfOneIsThatOne) {
  const std::vector fields{field_of(3, "only")};
  const auto mean = mean_of(fields);
  ASSERT_TRUE(mean);
  EXPECT_EQ(mean->at("head.weight").values, fields[0].at("head.weight").values);
}

TEST(MeanOfFields, TakesOneSizeOnly) {
  const std::vector fields{field_of(1, ""), weights::seeded_field({16, 32, 32}, 1)};
  const auto mean = mean_of(fields);
  ASSERT_FALSE(mean);
  EXPECT_EQ(mean.error().code, ErrorCode::kBadInput);
  EXPECT_NE(mean.error().message.find("16, 32 and 32"), std::string::npos) << mean.error().message;
  EXPECT_FALSE(mean_of({}));
}

}  // namespace
}  // namespace flowdlo::strand
