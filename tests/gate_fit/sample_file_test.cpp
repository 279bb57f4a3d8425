#include "gate_fit/sample_file.hpp"

#include <gtest/gtest.h>

#include "frame/temporary_folder.hpp"

namespace flowdlo::lab {
namespace {

const SampleOrigin kOrigin{.weights_sha256 = "ab",
                           .split = "wide",
                           .part = "training",
                           .first = 7,
                           .draws = 4,
                           .steps = 10};

SampleFile content() {
  GateSample sample;
  sample.index = 9;
  sample.scenario = "coil";
  sample.hard = true;
  sample.truth[3] = {0.1F, 0.2F, 0.3F};
  gate::Candidate candidate;
  candidate.nodes[63] = {0.4F, 0.5F, 0.6F};
  candidate.sigma_m[5] = 0.007F;
  candidate.unseen_m[6] = 0.03F;
  candidate.pixel_m = 0.0625F;
  candidate.noise_m = 0.5F;
  candidate.draw = 2;
  candidate.behind = 1.25;
  candidate.readings = 5;
  candidate.reread = true;
  candidate.votes = 0.4F;
  candidate.odds = 0.3F;
  candidate.tube.mask_recall = 0.75F;
  candidate.tube.sharpest_bend = 0.125F;
  sample.candidates = {candidate};
  sample.doubted = {1};
  return {.scenes = 3, .samples = {sample}};
}

TEST(SampleFile, GivesBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "samples.jsonl";
  ASSERT_TRUE(write_samples(file, kOrigin, content()));
  const auto read = read_samples(file, kOrigin);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->scenes, 3);
  ASSERT_EQ(read->samples.size(), 1U);
  const GateSample& sample = read->samples[0];
  const GateSample expected = content().samples[0];
  EXPECT_EQ(sample.index, 9U);
  EXPECT_EQ(sample.scenario, "coil");
  EXPECT_TRUE(sample.hard);
  EXPECT_EQ(sample.truth, expected.truth);
  ASSERT_EQ(sample.candidates.size(), 1U);
  EXPECT_EQ(sample.candidates[0].nodes, expected.candidates[0].nodes);
  EXPECT_EQ(sample.candidates[0].sigma_m, expected.candidates[0].sigma_m);
  EXPECT_EQ(sample.candidates[0].unseen_m, expected.candidates[0].unseen_m);
  EXPECT_EQ(sample.candidates[0].pixel_m, 0.0625F);
  EXPECT_EQ(sample.candidates[0].noise_m, 0.5F);
  EXPECT_EQ(sample.candidates[0].draw, 2);
  EXPECT_EQ(sample.candidates[0].behind, 1.25);
  EXPECT_EQ(sample.candidates[0].readings, 5);
  EXPECT_TRUE(sample.candidates[0].reread);
  EXPECT_EQ(sample.candidates[0].votes, 0.4F);
  EXPECT_EQ(sample.candidates[0].odds, 0.3F);
  EXPECT_EQ(sample.candidates[0].tube.mask_recall, 0.75F);
  EXPECT_EQ(sample.candidates[0].tube.sharpest_bend, 0.125F);
  EXPECT_EQ(sample.doubted, expected.doubted);
}

TEST(SampleFile, OfAnotherModelCountsAsNone) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "samples.jsonl";
  ASSERT_TRUE(write_samples(file, kOrigin, content()));
  SampleOrigin other = kOrigin;
  other.weights_sha256 = "cd";
  const auto read = read_samples(file, other);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->scenes, 0);
  EXPECT_TRUE(read->samples.empty());
}

TEST(SampleFile, ThatIsMissingCountsAsNone) {
  const test::TemporaryFolder folder;
  const auto read = read_samples(folder.path() / "none.jsonl", kOrigin);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->scenes, 0);
}

TEST(SampleFile, ThatIsCutShortNamesTheLine) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "samples.jsonl";
  ASSERT_TRUE(write_samples(file, kOrigin, content()));
  const std::string text = test::read_text(file);
  test::write_text(file, text.substr(0, text.size() - 40));
  const auto read = read_samples(file, kOrigin);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
  EXPECT_NE(read.error().message.find("samples.jsonl:2"), std::string::npos);
}

}  // namespace
}  // namespace flowdlo::lab
