#include "field/strand_field.hpp"

#include <gtest/gtest.h>

#include "reference/program.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::field {
namespace {

Network seeded() {
  auto made = Network::create(
      std::make_shared<const weights::FieldWeights>(weights::seeded_field({16, 16, 16}, 1)),
      [] { return reference::create_program(1); });
  if (!made) throw std::runtime_error(made.error().message);
  return *std::move(made);
}

TEST(StrandField, HasTheRegionsSize) {
  const testing::WaveFrame wave;
  auto network = seeded();
  const auto field = see(wave.frame(), 8, network);
  ASSERT_TRUE(field) << field.error().message;
  EXPECT_EQ(field->channels.size(), field->region.size);
  EXPECT_EQ(field->channels.channels(), static_cast<int>(kChannels));
}

TEST(StrandField, AnEmptyMaskHasNone) {
  const testing::WaveFrame wave;
  const std::vector<std::uint8_t> none(wave.frame().mask.size(), 0);
  Frame frame = wave.frame();
  frame.mask = none;
  auto network = seeded();
  const auto field = see(frame, 8, network);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, ErrorCode::kNoEvidence);
}

}  // namespace
}  // namespace flowdlo::field
