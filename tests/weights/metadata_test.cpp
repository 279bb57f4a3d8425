#include "weights/metadata.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace flowdlo::weights {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Metadata sample() {
  return {.name = "n",
          .version = "2",
          .training_data = "d",
          .licence = "MIT",
          .notes = "",
          .mean = {0.1F, -1e-7F, 3.0F},
          .scale = 1.0F / 3.0F,
          .trained = true,
          .variant = {.parameterization = ops::Parameterization::kDirect,
                      .local_channels = 8,
                      .visible_points = false,
                      .head_channels = 4,
                      .normalization = NormalizationKind::kFrame,
                      .prior_kind = PriorKind::kRefined,
                      .prior_sd = 0.7F}};
}

TEST(MetadataFields, ReadBackExactly) {
  std::vector<std::string> list;
  const auto back = from_fields(to_fields(sample()), list);
  EXPECT_THAT(list, IsEmpty());
  EXPECT_EQ(back.mean, sample().mean);
  EXPECT_EQ(back.scale, sample().scale);
  EXPECT_EQ(back.variant, sample().variant);
  EXPECT_EQ(to_fields(back), to_fields(sample()));
}

TEST(MetadataFields, FastQualityIsThereWhereItIsSet) {
  EXPECT_EQ(to_fields(sample()).count("fast_steps"), 0U);
  auto metadata = sample();
  metadata.fast_steps = 2;
  metadata.fast_draws = 1;
  std::vector<std::string> list;
  const auto back = from_fields(to_fields(metadata), list);
  EXPECT_THAT(list, IsEmpty());
  EXPECT_EQ(back.fast_steps, 2);
  EXPECT_EQ(back.fast_draws, 1);
}

TEST(MetadataFields, EveryMissingFieldButNotesIsAFault) {
  std::vector<std::string> list;
  static_cast<void>(from_fields({}, list));
  EXPECT_EQ(list.size(), to_fields(sample()).size() - 1);
}

TEST(MetadataFields, UnreadableValuesAreAllNamed) {
  auto fields = to_fields(sample());
  fields["mean"] = "1,2";
  fields["scale"] = "0.1x";
  fields["trained"] = "yes";
  fields["parameterization"] = "Velocity";
  fields["local_channels"] = "99999999999";
  std::vector<std::string> list;
  static_cast<void>(from_fields(fields, list));
  EXPECT_THAT(list, ElementsAre(HasSubstr("mean"), HasSubstr("scale"), HasSubstr("trained"),
                                HasSubstr("velocity or direct or preconditioned, got \"Velocity\""),
                                HasSubstr("local_channels")));
}

TEST(MetadataFaults, SoundMetadataHasNone) { EXPECT_THAT(faults(sample()), IsEmpty()); }

TEST(MetadataFaults, ImpossibleNumbersAreAllNamed) {
  auto metadata = sample();
  metadata.mean[1] = std::nanf("");
  metadata.scale = -1;
  metadata.variant.prior_sd = 0;
  metadata.variant.local_channels = 7;
  metadata.variant.head_channels = 0;
  metadata.variant.local_features_version = 0;
  EXPECT_THAT(faults(metadata),
              ElementsAre(HasSubstr("mean"), HasSubstr("scale"), HasSubstr("local_channels"),
                          HasSubstr("head_channels"), HasSubstr("prior_sd"),
                          HasSubstr("local_features_version")));
}

TEST(MetadataFaults, FastQualityBeyondWhatAnEstimatorTakesIsOne) {
  auto metadata = sample();
  metadata.fast_steps = 65;
  metadata.fast_draws = -1;
  EXPECT_THAT(faults(metadata), ElementsAre(HasSubstr("fast_steps: expected 0 to 64, got 65"),
                                            HasSubstr("fast_draws")));
}

TEST(MetadataFaults, EmptyNameIsOne) {
  auto metadata = sample();
  metadata.name.clear();
  EXPECT_THAT(faults(metadata), ElementsAre(HasSubstr("name")));
}

TEST(Utf8, TakesEveryLengthAndTheEdges) {
  for (const char* text : {"", "a", "\xc2\x80", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                           "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(is_utf8(text)) << text;
  }
}

TEST(Utf8, RefusesStrayOverlongSurrogateAndCutSequences) {
  for (const char* text :
       {"\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80",
        "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xc3", "\xe2\x82", "\xc3z", "\xff"}) {
    EXPECT_FALSE(is_utf8(text)) << testing::PrintToString(std::string{text});
  }
}

}  // namespace
}  // namespace flowdlo::weights
