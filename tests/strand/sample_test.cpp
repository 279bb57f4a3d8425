#include "strand/sample.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "straight.hpp"

namespace flowdlo::strand {
namespace {

constexpr int kSize_px = 64;

/// A level rope 8 px wide, red on grey.
Patch level_rope() {
  Patch patch;
  patch.width = 160;
  patch.height = 160;
  patch.focal_px = 500;
  patch.rope_px = 8;
  for (int v = 0; v < patch.height; ++v) {
    for (int u = 0; u < patch.width; ++u) {
      const bool rope = v >= 76 && v < 84;
      patch.mask.push_back(rope ? 255 : 0);
      patch.depth.push_back(rope ? 4920 : 5000);
      for (const int level : {100, rope ? 30 : 100, rope ? 220 : 100}) {
        patch.color_bgr.push_back(static_cast<std::uint8_t>(level));
      }
    }
  }
  patch.strands = {straight(0, 79.5F, 159, 79.5F)};
  return patch;
}

/// Nothing spoiled that a recipe can leave out.
SpoilConfig gentle() {
  SpoilConfig config;
  config.width_spread = 0;
  config.width_wrong_share = 0;
  config.no_color = config.no_depth = config.mask_alone = 0;
  return config;
}

float channel(const Sample& sample, int u, int v, field::Channel c) {
  return sample.target.ptr<float>(v)[u * field::kChannels + c];
}

TEST(Sample, TheSameNumberGivesTheSameSample) {
  const Patch patch = level_rope();
  const Sample a = sample_of(patch, kSize_px, 1, 17);
  const Sample b = sample_of(patch, kSize_px, 1, 17);
  const Sample c = sample_of(patch, kSize_px, 1, 18);
  EXPECT_EQ(cv::norm(a.input, b.input, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a.target, b.target, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(a.input, c.input, cv::NORM_INF), 0);
}

TEST(Sample, TruthTurnsWithThePicture) {
  const Patch patch = level_rope();
  double agreement = 0;
  int samples = 0;
  for (std::uint64_t number = 0; number < 40; ++number) {
    const Sample sample = sample_of(patch, kSize_px, 2, number, gentle());
    double both = 0;
    double rope = 0;
    for (int v = 0; v < kSize_px; ++v) {
      for (int u = 0; u < kSize_px; ++u) {
        const float mask = sample.input.ptr<float>(v)[u * field::kPlanes + field::kMask];
        const float truth = channel(sample, u, v, field::kRope);
        rope += static_cast<double>(truth);
        both += static_cast<double>(truth * mask);
      }
    }
    if (rope < 50) continue;
    agreement += both / rope;
    ++samples;
  }
  ASSERT_GT(samples, 25);
  EXPECT_GT(agreement / samples, 0.75) << "masks are spoiled, but not most of them";
}

TEST(Sample, AWidthBelievedTooLargeMakesTheRopeThinAndItsTargetSaysSo) {
  SpoilConfig config = gentle();
  config.width_wrong_share = 1;
  config.width_wrong = 2;
  const Patch patch = level_rope();
  float least = 10;
  float most = -10;
  for (std::uint64_t number = 0; number < 60; ++number) {
    const Sample sample = sample_of(patch, kSize_px, 3, number, config);
    for (int v = 0; v < kSize_px; ++v) {
      for (int u = 0; u < kSize_px; ++u) {
        if (channel(sample, u, v, field::kRope) < 1) continue;
        least = std::min(least, channel(sample, u, v, field::kWidth));
        most = std::max(most, channel(sample, u, v, field::kWidth));
      }
    }
  }
  EXPECT_LT(least, -0.8F);
  EXPECT_GT(most, 0.8F);
  EXPECT_GE(least, -1.01F);
  EXPECT_LE(most, 1.01F);
}

TEST(Sample, WhatTheCameraDoesNotGiveIsNotThere) {
  SpoilConfig config = gentle();
  config.mask_alone = 1;
  const Sample sample = sample_of(level_rope(), kSize_px, 4, 1, config);
  for (int i = 0; i < kSize_px * kSize_px; ++i) {
    const float* const in = sample.input.ptr<float>() + i * field::kPlanes;
    for (const int plane : {field::kBlue, field::kHasColor, field::kDepth, field::kHasDepth}) {
      ASSERT_EQ(in[plane], 0);
    }
  }
}

/// How clearly the rope's middle row stands out of what lies 12 px beside it, in the red plane.
double contrast(const SpoilConfig& config) {
  const Patch patch = level_rope();
  double all = 0;
  for (std::uint64_t number = 0; number < 30; ++number) {
    const Sample sample = sample_of(patch, kSize_px, 6, number, config);
    double rope = 0;
    double ground = 0;
    double on = 0;
    double off = 0;
    for (int v = 0; v < kSize_px; ++v) {
      for (int u = 0; u < kSize_px; ++u) {
        const float red = sample.input.ptr<float>(v)[u * field::kPlanes + field::kRed];
        const bool is_rope = channel(sample, u, v, field::kRope) > 0;
        (is_rope ? rope : ground) += static_cast<double>(red);
        (is_rope ? on : off) += 1;
      }
    }
    if (on > 0 && off > 0) all += std::abs(rope / on - ground / off) / 30;
  }
  return all;
}

TEST(Sample, APictureOfOneColourTellsNothing) {
  SpoilConfig config = gentle();
  const double usual = contrast(config);
  config.flat = 1;
  const double flat = contrast(config);
  EXPECT_GT(usual, 0.5);
  EXPECT_LT(flat, 0.2 * usual);
}

TEST(Sample, SharesOfZeroLeaveEverySampleAsItWas) {
  SpoilConfig config = gentle();
  const Sample before = sample_of(level_rope(), kSize_px, 7, 3, config);
  for (double SpoilConfig::*share : {&SpoilConfig::dark, &SpoilConfig::moved, &SpoilConfig::flat}) {
    SpoilConfig spoiled = config;
    spoiled.*share = 1;
    const Sample after = sample_of(level_rope(), kSize_px, 7, 3, spoiled);
    EXPECT_GT(cv::norm(before.input, after.input, cv::NORM_INF), 0.01);
    EXPECT_EQ(cv::norm(before.target, after.target, cv::NORM_INF), 0);
  }
}

TEST(Sample, EveryValueIsANumberWithinItsBounds) {
  const Patch patch = level_rope();
  for (std::uint64_t number = 0; number < 100; ++number) {
    const Sample sample = sample_of(patch, kSize_px, 5, number);
    for (int i = 0; i < kSize_px * kSize_px * field::kPlanes; ++i) {
      ASSERT_LE(std::abs(sample.input.ptr<float>()[i]), 3) << number;
    }
    for (int i = 0; i < kSize_px * kSize_px * field::kChannels; ++i) {
      ASSERT_LE(std::abs(sample.target.ptr<float>()[i]), 4) << number;
    }
  }
}

}  // namespace
}  // namespace flowdlo::strand
