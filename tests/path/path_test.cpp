#include "path/path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"

namespace flowdlo::test {
namespace {

Curve wave() {
  return curve_of([](double t) {
    return std::pair{60 + 500 * t, 240 + 110 * std::sin(2 * kPi * t)};
  });
}

TEST(Path, FollowsAStraightStrokeFromTipToTip) {
  const Curve line{{100, 240}, {540, 240}};
  const Canvas canvas = Canvas().stroke(line, 12);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), curve_of([](double t) {
                      return std::pair{94 + 452 * t, 240.0};  // round caps reach six pixels further
                    })),
            3.0F);
  EXPECT_NEAR(traced->rope_width_px, 12.0F, 2.0F);
}

TEST(Path, OfTheLargestFrameIsFollowedAtHalfItsSizeAndComesBackInItsPixels) {
  const Curve line{{300, 3500}, {2000, 700}, {3700, 3300}};
  const Canvas canvas = Canvas(4096, 4096).stroke(line, 60);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_NEAR(traced->rope_width_px, 60.0F, 4.0F);
  EXPECT_LT(distance_to(traced->ranked.front().points_px, line[0]), 35.0F);
  EXPECT_LT(distance_to(traced->ranked.front().points_px, line[1]), 30.0F) << "half a width";
  EXPECT_LT(distance_to(traced->ranked.front().points_px, line[2]), 35.0F);
  EXPECT_TRUE(sound(traced->ranked.front(), canvas.frame()));
}

TEST(Path, FollowsAnSWithinAPixelAndAHalf) {
  const Canvas canvas = Canvas().stroke(wave(), 11);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  for (std::size_t i = 10; i + 10 < points.size(); ++i) {
    float least = 1e9F;
    for (const cv::Point& p : wave()) {
      const Vector2f q(static_cast<float>(p.x), static_cast<float>(p.y));
      least = std::min(least, (points[i] - q).norm());
    }
    ASSERT_LT(least, 1.8F) << "sample " << i;  // the drawn curve is itself a pixel grid
  }
}

TEST(Path, SamplesAreAboutOnePixelApart) {
  const Canvas canvas = Canvas().stroke(wave(), 9);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const float step = (points[i] - points[i - 1]).norm();
    EXPECT_GT(step, 0.2F);
    EXPECT_LT(step, 1.6F);
  }
}

TEST(Path, IsTheSameEveryTime) {
  const Canvas canvas = Canvas().stroke(wave(), 9).stroke({{300, 60}, {340, 420}}, 9);

  const auto first = path::trace(canvas.frame());
  const auto second = path::trace(canvas.frame());

  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  ASSERT_EQ(first->ranked.size(), second->ranked.size());
  for (std::size_t k = 0; k < first->ranked.size(); ++k) {
    EXPECT_EQ(first->ranked[k].points_px, second->ranked[k].points_px);
    EXPECT_EQ(first->ranked[k].score, second->ranked[k].score);
  }
}

TEST(Path, FollowsRopesFromTwoToEightyPixelsWide) {
  for (const int width : {2, 3, 4, 6, 10, 20, 40, 80}) {
    const Curve arc = curve_of([](double t) {
      return std::pair{320 - 240 * std::cos(kPi * t), 400 - 280 * std::sin(kPi * t)};
    });
    const Canvas canvas = Canvas().stroke(arc, width);

    const auto traced = path::trace(canvas.frame());

    ASSERT_TRUE(traced) << width;
    EXPECT_LT(frechet(traced->ranked.front(), arc), 0.6F * static_cast<float>(width) + 3.0F)
        << width;
  }
}

TEST(Path, FollowsAThinDiagonalToItsVeryEnds) {
  for (const int width : {1, 2, 3}) {
    const Curve line{{100, 100}, {400, 400}};
    const Canvas canvas = Canvas().stroke(line, width);

    const auto traced = path::trace(canvas.frame());

    ASSERT_TRUE(traced) << width;
    const auto& points = traced->ranked.front().points_px;
    EXPECT_LT(distance_to(points, {100, 100}), 4.0F) << width;
    EXPECT_LT(distance_to(points, {400, 400}), 4.0F) << width;
  }
}

TEST(Path, IgnoresRaggedBorders) {
  Canvas canvas = Canvas().stroke(wave(), 16);
  cv::RNG noise(7);
  const cv::Mat before = canvas.mask.clone();
  for (int v = 2; v < 478; ++v) {
    for (int u = 2; u < 638; ++u) {
      const bool edge = before.at<std::uint8_t>(v, u - 2) != before.at<std::uint8_t>(v, u + 2) ||
                        before.at<std::uint8_t>(v - 2, u) != before.at<std::uint8_t>(v + 2, u);
      if (edge && noise.uniform(0, 2) == 0) canvas.mask.at<std::uint8_t>(v, u) = 255;
    }
  }

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  EXPECT_LT(frechet(traced->ranked.front(), wave()), 12.0F);
}

TEST(Path, DropsThornsOnTheBorder) {
  const Canvas canvas = Canvas()
                            .stroke({{80, 240}, {560, 240}}, 14)
                            .stroke({{200, 240}, {200, 225}}, 4)
                            .stroke({{420, 240}, {428, 256}}, 3);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  for (const Vector2f& p : traced->ranked.front().points_px) EXPECT_NEAR(p.y(), 240, 3);
}

TEST(Path, GoesStraightOverAHighlight) {
  Canvas canvas = Canvas().stroke({{80, 240}, {560, 240}}, 16);
  cv::ellipse(canvas.mask, {300, 241}, {25, 3}, 0, 0, 360, cv::Scalar(0), -1);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  for (const Vector2f& p : traced->ranked.front().points_px) EXPECT_NEAR(p.y(), 240, 2.5);
}

TEST(Path, CutsAClosedRingAtItsLeftmostPoint) {
  Canvas canvas;
  cv::circle(canvas.mask, {320, 240}, 120, cv::Scalar(255), 10);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  EXPECT_LT((points.front() - points.back()).norm(), 6.0F);
  EXPECT_NEAR(points.front().x(), 200, 4);
  EXPECT_GT(points.size(), 700U) << "the whole circumference, 754 px";
}

TEST(Path, FollowsARopeThatLeavesTheImage) {
  const Canvas canvas = Canvas().stroke({{-40, 200}, {320, 260}, {700, 200}}, 14);

  const auto traced = path::trace(canvas.frame());

  ASSERT_TRUE(traced);
  const auto& points = traced->ranked.front().points_px;
  EXPECT_LT(distance_to(points, {0, 207}), 5.0F);
  EXPECT_LT(distance_to(points, {639, 209}), 5.0F);
}

TEST(Path, TellsAKnownLengthFromAWrongOne) {
  // A ring of rope beside the strand: with the short length it is no part of the rope.
  const Curve strand{{60, 400}, {580, 400}};
  const Curve piece{{200, 200}, {440, 200}};
  const Canvas canvas = Canvas()
                            .stroke(strand, 12)
                            .stroke(piece, 12)
                            .depth(strand, 14, 0.64F)
                            .depth(piece, 14, 0.64F);

  const auto shorter = path::trace(canvas.frame(), {.alternatives = 6, .rope_length_m = 0.52});

  ASSERT_TRUE(shorter);
  EXPECT_GT(distance_to(shorter->ranked.front().points_px, {320, 200}), 100.0F);
}

TEST(Path, ReadingsOfOneFrameMayShareTheCleanedMask) {
  const Canvas canvas = Canvas().stroke(wave(), 12);
  const Frame frame = canvas.frame();
  const auto alone = path::trace(frame);

  const auto seen = path::glance(frame);

  ASSERT_TRUE(seen && seen->cleaned);
  EXPECT_FALSE(seen->filtered);
  EXPECT_GT(seen->slender, 10);
  EXPECT_NEAR(seen->rope_width_px, 12, 2);
  for (int time = 0; time < 2; ++time) {  // a reading leaves what it shares as it was
    const auto traced = path::trace(frame, {.cleaned = seen->cleaned});
    ASSERT_TRUE(alone && traced);
    EXPECT_EQ(traced->ranked.front().points_px, alone->ranked.front().points_px);
    EXPECT_EQ(traced->rope_width_px, alone->rope_width_px);
  }
}

TEST(Path, AMaskThatIsReadReducedHasNothingToShare) {
  const Canvas canvas =
      Canvas(4096, 4096).stroke(Curve{{300, 3500}, {2000, 700}, {3700, 3300}}, 60);
  const auto seen = path::glance(canvas.frame());
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->cleaned, nullptr);
  EXPECT_NEAR(seen->rope_width_px, 60, 6);
}

TEST(Path, AnEmptyMaskHasNothingToShareAndSaysSo) {
  const auto seen = path::glance(Canvas().frame());
  ASSERT_FALSE(seen);
  EXPECT_EQ(seen.error().code, ErrorCode::kNoPath);
}

}  // namespace
}  // namespace flowdlo::test
