// Hints: what is refused, which end comes first, and what decides where a frame does not.
#include "flowdlo/hints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

#include "flowdlo/estimator.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"
#include "support/estimate_bits.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using testing::bits_of;
using ::testing::HasSubstr;
using testing::WaveFrame;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Three arms of 10 px from one place: any two may be the rope, and the third a thing beside it.
struct Star {
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  static constexpr std::array<Pixel, 3> kTips{{{160, 40}, {255, 175}, {65, 175}}};

  Star() : mask(cv::Mat::zeros(kHeight, kWidth, CV_8U)) {
    for (const Pixel& tip : kTips) {
      cv::line(mask, {160, 120}, {static_cast<int>(tip.u), static_cast<int>(tip.v)},
               cv::Scalar(255), 10);
    }
    for (int i = 0; i < kWidth * kHeight; ++i) {
      depth_m.push_back(mask.data[i] != 0 ? 0.5F : 0.6F);  // a wall behind it
    }
  }

  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, kCamera, depth_m, {mask.data, mask.total()}, {}};
  }
  static constexpr Intrinsics kCamera{300, 300, 160, 120};
  cv::Mat mask;
  std::vector<float> depth_m;
};

Pixel seen_at(const Point3& node, const Intrinsics& camera) {
  const auto place = geometry::project(camera, node);
  return {place.x(), place.y()};
}

double pixels_between(const Pixel& a, const Pixel& b) { return std::hypot(a.u - b.u, a.v - b.v); }

Centerline reversed(Centerline nodes) {
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

class Hinted : public ::testing::Test {
 protected:
  /// The prior of the way that explains the frame best, in the order in which nothing hints.
  Centerline first_prior(const Frame& frame) {
    Tensors tensors;
    const auto estimate = estimator_.estimate(frame, tensors);
    if (!estimate) throw std::runtime_error(estimate.error().message);
    Centerline nodes;
    for (std::size_t i = 0; i < kNodes; ++i) {
      nodes[i] = {tensors.prior[3 * i], tensors.prior[3 * i + 1], tensors.prior[3 * i + 2]};
    }
    return nodes;
  }
  Estimate of(const Frame& frame, const Hints& hints = {}) {
    auto estimate = estimator_.estimate(frame, hints);
    if (!estimate) throw std::runtime_error(estimate.error().message);
    return *std::move(estimate);
  }
  Error refused(const Hints& hints) {
    const auto estimate = estimator_.estimate(wave_.frame(), hints);
    return estimate ? Error{ErrorCode::kInternal, "accepted"} : estimate.error();
  }

  /// Nodes stay where a prior has them, so that they tell which one it is.
  static Estimator make(FieldChoice field = FieldChoice::kStrands) {
    auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                                        .device = "cpu",
                                        .quality = Quality::kFast,
                                        .field = field});
    if (!estimator) throw std::runtime_error(estimator.error().message);
    return *std::move(estimator);
  }

  WaveFrame wave_;
  Star star_;
  Estimator estimator_ = make();
};

TEST_F(Hinted, WithoutAnyHintNothingChanges) {
  auto plain = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                                  .device = "cpu",
                                  .quality = Quality::kFast,
                                  .field = FieldChoice::kStrands});
  ASSERT_TRUE(plain);
  const auto estimate = plain->estimate(star_.frame());
  ASSERT_TRUE(estimate);
  const Estimate hinted = of(star_.frame());
  EXPECT_EQ(bits_of(hinted), bits_of(*estimate));
  EXPECT_FALSE(hinted.reversed);
  EXPECT_FALSE(hinted.switched);
}

TEST_F(Hinted, TheEndNearestToThePixelIsNodeZero) {
  const Estimate plain = of(wave_.frame());
  const Pixel left = seen_at(plain.nodes.front(), wave_.camera);
  const Pixel right = seen_at(plain.nodes.back(), wave_.camera);
  const Estimate same = of(wave_.frame(), {.first_end = left});
  EXPECT_EQ(same.nodes, plain.nodes);
  EXPECT_FALSE(same.reversed);
  const Estimate turned = of(wave_.frame(), {.first_end = Pixel{right.u - 30, right.v + 20}});
  EXPECT_EQ(turned.nodes, reversed(plain.nodes));
  EXPECT_TRUE(turned.reversed);
  EXPECT_FALSE(turned.switched);
}

TEST_F(Hinted, TheEndNearestToThePointIsNodeZero) {
  const Estimate plain = of(wave_.frame());
  EXPECT_EQ(of(wave_.frame(), {.first_end = plain.nodes.back()}).nodes, reversed(plain.nodes));
  EXPECT_EQ(of(wave_.frame(), {.first_end = plain.nodes.front()}).nodes, plain.nodes);
}

TEST_F(Hinted, WhatBelongsToTheNodesIsTurnedWithThem) {
  std::fill(wave_.depth_m.begin(), wave_.depth_m.begin() + 320 * 110, 0.0F);  // crests
  const Estimate plain = of(wave_.frame());
  const Estimate turned = of(wave_.frame(), {.first_end = plain.nodes.back()});
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_EQ(turned.support[i], plain.support[kNodes - 1 - i]);
    EXPECT_EQ(turned.sigma_m[i], plain.sigma_m[kNodes - 1 - i]);
  }
  auto mirrored = plain.sigma_m;
  std::reverse(mirrored.begin(), mirrored.end());
  ASSERT_NE(plain.sigma_m, mirrored) << "otherwise nothing was seen";
}

TEST_F(Hinted, EachAlternativeIsTurnedForItself) {
  const Estimate plain = of(star_.frame());
  ASSERT_FALSE(plain.alternatives.empty());
  for (const Pixel& tip : Star::kTips) {
    for (const auto& other : of(star_.frame(), {.first_end = tip}).alternatives) {
      EXPECT_LE(pixels_between(seen_at(other.nodes.front(), Star::kCamera), tip),
                pixels_between(seen_at(other.nodes.back(), Star::kCamera), tip));
    }
  }
}

TEST_F(Hinted, TheOrderOfTheFrameBeforeIsKept) {
  const Estimate plain = of(wave_.frame());
  const Estimate kept = of(wave_.frame(), {.previous = reversed(plain.nodes)});
  EXPECT_EQ(kept.nodes, reversed(plain.nodes));
  EXPECT_TRUE(kept.reversed);
  EXPECT_FALSE(of(wave_.frame(), {.previous = plain.nodes}).reversed);
}

TEST_F(Hinted, TheFirstEndWinsOverTheOrderOfTheFrameBefore) {
  const Estimate plain = of(wave_.frame());
  const Estimate estimate =
      of(wave_.frame(), {.first_end = plain.nodes.front(), .previous = reversed(plain.nodes)});
  EXPECT_EQ(estimate.nodes, plain.nodes);
}

TEST_F(Hinted, TensorsKeepTheirOrder) {
  auto estimator = Estimator::create(
      {.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = "cpu", .quality = Quality::kFast});
  ASSERT_TRUE(estimator);
  Tensors plain;
  Tensors hinted;
  const auto estimate = estimator->estimate(wave_.frame(), plain);
  ASSERT_TRUE(estimate);
  ASSERT_TRUE(estimator->estimate(wave_.frame(), {.first_end = estimate->nodes.back()}, hinted));
  EXPECT_EQ(bits_of(hinted), bits_of(plain));
}

TEST_F(Hinted, TheRopeEndsWhereBothEndsAreGiven) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Pixel& one = Star::kTips[i];
    const Pixel& other = Star::kTips[(i + 1) % 3];
    const Estimate estimate = of(star_.frame(), {.first_end = one, .ends = {one, other}});
    EXPECT_LT(pixels_between(seen_at(estimate.nodes.front(), Star::kCamera), one), 12);
    EXPECT_LT(pixels_between(seen_at(estimate.nodes.back(), Star::kCamera), other), 12);
  }
}

TEST_F(Hinted, OneGivenEndLeavesTheOtherFree) {
  for (const Pixel& tip : Star::kTips) {
    const Estimate estimate = of(star_.frame(), {.first_end = tip, .ends = {tip}});
    EXPECT_LT(pixels_between(seen_at(estimate.nodes.front(), Star::kCamera), tip), 12);
  }
}

TEST_F(Hinted, EndsFarFromTheRopeDoNoHarm) {
  const Estimate plain = of(wave_.frame());
  const Estimate estimate = of(wave_.frame(), {.ends = {Pixel{160, 0}, Pixel{170, 0}}});
  EXPECT_EQ(estimate.nodes, plain.nodes);
}

TEST_F(Hinted, AFrameThatLeavesItOpenFollowsTheFrameBefore) {
  estimator_ = make(FieldChoice::kOff);  // by the mask alone all its arms are alike
  const Estimate plain = of(star_.frame());
  int followed = 0;  // of the ways elsewhere; the gate may be sure that one of them is wrong
  for (const Alternative& elsewhere : plain.alternatives) {
    if (geometry::mean_distance(elsewhere.nodes, plain.nodes) <= 0.02) continue;
    const Estimate after = of(star_.frame(), {.previous = elsewhere.nodes});
    const bool follows = geometry::mean_distance(after.nodes, elsewhere.nodes) < 0.005;
    EXPECT_EQ(after.switched, follows);
    followed += follows ? 1 : 0;
  }
  EXPECT_GE(followed, 2);
  EXPECT_FALSE(of(star_.frame(), {.previous = plain.nodes}).switched);
}

TEST_F(Hinted, OriginSaysWhichCandidateWasReturned) {
  const Estimate plain = of(star_.frame());
  const Centerline first = first_prior(star_.frame());
  std::set<Origin> found{plain.origin, of(wave_.frame()).origin};
  for (const Alternative& elsewhere : plain.alternatives) {
    Centerline moved = elsewhere.nodes;  // by less than a pixel: no reading has exactly these nodes
    for (Point3& node : moved) node.x += 0.0005F;
    const Estimate estimate = of(star_.frame(), {.previous = moved});
    found.insert(estimate.origin);
    const bool is_first = estimate.nodes == first || estimate.nodes == reversed(first);
    const bool is_before = estimate.nodes == moved || estimate.nodes == reversed(moved);
    EXPECT_EQ(estimate.origin == Origin::kFirstPrior, is_first);
    EXPECT_EQ(estimate.origin == Origin::kFrameBefore, is_before);
    EXPECT_EQ(estimate.origin == Origin::kDraw, estimate.source == Source::kPrediction);
    EXPECT_TRUE(estimate.origin != Origin::kOtherReading || estimate.readings > 1);
  }
  EXPECT_THAT(found, ::testing::IsSupersetOf({Origin::kFirstPrior, Origin::kFrameBefore}));
}

TEST_F(Hinted, AFrameThatIsClearOverrulesTheFrameBefore) {
  const Estimate plain = of(wave_.frame());
  Centerline half = plain.nodes;  // as if the rope had ended in the middle
  for (std::size_t i = 0; i < kNodes; ++i) half[i] = plain.nodes[i / 2];
  const Estimate estimate = of(wave_.frame(), {.previous = half});
  EXPECT_EQ(estimate.nodes, plain.nodes);
  EXPECT_FALSE(estimate.switched);
  EXPECT_EQ(estimate.confidence, plain.confidence);
}

TEST_F(Hinted, ARopeThatMovedIsWhereItIsNow) {
  const Estimate plain = of(wave_.frame());
  Centerline beside = plain.nodes;
  for (Point3& node : beside) node.y += 0.02F;
  EXPECT_EQ(of(wave_.frame(), {.previous = beside}).nodes, plain.nodes);
  for (Point3& node : beside) node = {5, 5, 2};
  EXPECT_EQ(of(wave_.frame(), {.previous = beside}).nodes, plain.nodes);
}

TEST_F(Hinted, AFrameBeforeThatIsNotFiniteSaysNothing) {
  const Estimate plain = of(star_.frame());
  Centerline broken = reversed(plain.nodes);
  broken[7].y = kNan;
  EXPECT_EQ(bits_of(of(star_.frame(), {.previous = broken})), bits_of(plain));
  broken.fill({std::numeric_limits<float>::infinity(), 0, -1});
  EXPECT_EQ(bits_of(of(star_.frame(), {.previous = broken})), bits_of(plain));
}

TEST_F(Hinted, TheLengthOfOneFrameTakesThePlaceOfTheConfigs) {
  const auto with_length = [&](double config_m, std::optional<double> hint_m) {
    auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                                        .device = "cpu",
                                        .quality = Quality::kFast,
                                        .rope_length_m = config_m});
    if (!estimator) throw std::runtime_error(estimator.error().message);
    const auto estimate = estimator->estimate(star_.frame(), {.rope_length_m = hint_m});
    if (!estimate) throw std::runtime_error(estimate.error().message);
    return bits_of(*estimate);
  };
  const auto known = with_length(0.1, std::nullopt);
  EXPECT_NE(known, with_length(0, std::nullopt));
  EXPECT_EQ(known, with_length(0.7, 0.1));
  EXPECT_EQ(with_length(0, std::nullopt), with_length(0.1, 0.0));
}

TEST_F(Hinted, EveryFaultIsNamed) {
  const Error error = refused({.first_end = Pixel{kNan, 0},
                               .ends = {Pixel{0, 9999}, Point3{0, 0, -1}, Pixel{}},
                               .rope_length_m = -1});
  EXPECT_EQ(error.code, ErrorCode::kBadInput);
  EXPECT_THAT(error.message,
              HasSubstr("Hints.first_end: expected a pixel with u from -320 to 640"));
  EXPECT_THAT(error.message, HasSubstr("Hints.ends: expected 2 at most, got 3"));
  EXPECT_THAT(error.message, HasSubstr("Hints.ends[0]: expected a pixel"));
  EXPECT_THAT(error.message, HasSubstr("Hints.ends[1]: expected a point in front of the camera"));
  EXPECT_THAT(error.message, HasSubstr("Hints.rope_length_m: expected metres"));
  EXPECT_EQ(refused({.rope_length_m = std::numeric_limits<double>::infinity()}).code,
            ErrorCode::kBadInput);
  EXPECT_EQ(refused({.first_end = Point3{kNan, 0, 1}}).code, ErrorCode::kBadInput);
}

TEST(Curve, OfAnEstimateIsAsDenseAsAsked) {
  Estimate estimate;
  for (std::size_t i = 0; i < kNodes; ++i)
    estimate.nodes[i] = {0.01F * static_cast<float>(i), 0, 1};
  const auto curve = estimate.curve(512);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->size(), 512U);
  EXPECT_EQ(curve->front(), estimate.nodes.front());
  EXPECT_EQ(curve->back(), estimate.nodes.back());
}

TEST(Curve, RefusesWhatIsNoNumberOfPointsAndNodesThatAreNotFinite) {
  Estimate estimate;
  for (const int points : {-1, 1, kMostCurvePoints + 1}) {
    const auto curve = estimate.curve(points);
    ASSERT_FALSE(curve);
    EXPECT_EQ(curve.error().code, ErrorCode::kBadInput);
    EXPECT_THAT(curve.error().message, HasSubstr("expected 2 to 65536"));
  }
  estimate.nodes[9].z = kNan;
  const auto curve = estimate.curve(64);
  ASSERT_FALSE(curve);
  EXPECT_THAT(curve.error().message, HasSubstr("at node 9"));
}

/// By the weights that ship, which bring networks that move nodes.
TEST(KnownEnds, AnEndGoesWhereItIsGivenIfThatIsNear) {
  auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = "cpu"});
  ASSERT_TRUE(estimator) << estimator.error().message;
  const WaveFrame wave;
  const auto seen = estimator->estimate(wave.frame());
  ASSERT_TRUE(seen) << seen.error().message;
  const auto& first = seen->nodes[0];
  const auto& next = seen->nodes[4];
  const float length = static_cast<float>(geometry::distance(first, next));
  // Two centimetres farther on, and five to its side.
  const auto ahead = [&](float by_m) {
    return Point3{first.x + by_m / length * (first.x - next.x),
                  first.y + by_m / length * (first.y - next.y),
                  first.z + by_m / length * (first.z - next.z)};
  };
  const Point3 beyond = ahead(0.02F);
  const Pixel beyond_px{wave.camera.fx * beyond.x / beyond.z + wave.camera.cx,
                        wave.camera.fy * beyond.y / beyond.z + wave.camera.cy};
  for (const Place& place : {Place(beyond), Place(beyond_px), Place(ahead(-0.01F))}) {
    Hints hints;
    hints.ends = {place};
    const auto told = estimator->estimate(wave.frame(), hints);
    ASSERT_TRUE(told) << told.error().message;
    const Point3 wanted = place == Place(ahead(-0.01F)) ? ahead(-0.01F) : beyond;
    EXPECT_LT(geometry::distance(told->nodes.front(), wanted), 0.004);
    EXPECT_LT(geometry::distance(told->nodes.back(), seen->nodes.back()), 0.002);
  }
  Hints elsewhere;
  elsewhere.ends = {Point3{first.x, first.y + 0.1F, first.z}};
  const auto same = estimator->estimate(wave.frame(), elsewhere);
  ASSERT_TRUE(same) << same.error().message;
  EXPECT_LT(geometry::mean_distance(same->nodes, seen->nodes), 1e-4);
}

/// By the weights that ship, which bring a network of tips.
TEST(KnownLength, WhatTheFrameLacksOfItIsAddedAtTheEndsAndTheFrameBeforeKeepsIt) {
  auto estimator = Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS, .device = "cpu"});
  ASSERT_TRUE(estimator) << estimator.error().message;
  const WaveFrame wave;
  const auto seen = estimator->estimate(wave.frame());
  ASSERT_TRUE(seen) << seen.error().message;
  const auto seen_m = static_cast<double>(geometry::length(seen->nodes));

  Hints hints;
  hints.rope_length_m = 1.3 * seen_m;
  const auto whole = estimator->estimate(wave.frame(), hints);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto whole_m = static_cast<double>(geometry::length(whole->nodes));
  EXPECT_NEAR(whole_m, 0.99 * 1.3 * seen_m, 0.01 * seen_m);
  EXPECT_EQ(whole->support.front() & whole->support.back(), 0) << "one end at least is a guess";
  const auto most_m = [](const Estimate& of) {
    return static_cast<double>(std::max(of.sigma_m.front(), of.sigma_m.back()));
  };
  EXPECT_GT(most_m(*whole), 0.05 * seen_m) << "and says so";
  EXPECT_LT(most_m(*seen), 0.05 * seen_m);

  hints.previous = whole->nodes;
  const auto again = estimator->estimate(wave.frame(), hints);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_FALSE(again->switched);
  EXPECT_LT(geometry::mean_distance(again->nodes, whole->nodes), 0.003);

  hints.rope_length_m = seen_m;
  hints.previous.reset();
  const auto met = estimator->estimate(wave.frame(), hints);
  ASSERT_TRUE(met);
  EXPECT_EQ(met->nodes, seen->nodes);
}

}  // namespace
}  // namespace flowdlo
