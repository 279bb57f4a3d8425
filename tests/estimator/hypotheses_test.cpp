#include "estimator/hypotheses.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using Draws = std::vector<int>;

TEST(AssignDraws, AClearWinnerTakesAllDraws) {
  EXPECT_EQ(estimator::assign_draws(3, 0.9F, 4), (Draws{0, 0, 0, 0}));
}

TEST(AssignDraws, InDoubtRunnersUpGetADrawEach) {
  EXPECT_EQ(estimator::assign_draws(3, 0.1F, 4), (Draws{0, 0, 2, 1}));
  EXPECT_EQ(estimator::assign_draws(2, 0.1F, 4), (Draws{0, 0, 0, 1}));
}

TEST(AssignDraws, TheWinnerKeepsAtLeastHalf) {
  EXPECT_EQ(estimator::assign_draws(9, 0.0F, 5), (Draws{0, 0, 0, 2, 1}));
  EXPECT_EQ(estimator::assign_draws(9, 0.0F, 1), (Draws{0}));
}

TEST(AssignDraws, WithoutARunnerUpThereIsNothingToAssign) {
  EXPECT_EQ(estimator::assign_draws(1, 0.0F, 2), (Draws{0, 0}));
}

TEST(SpreadDraws, EveryHypothesisGetsADrawHoweverClearTheWinner) {
  EXPECT_EQ(estimator::spread_draws(3, 4), (Draws{0, 0, 2, 1}));
  EXPECT_EQ(estimator::spread_draws(4, 4), (Draws{0, 3, 2, 1}));
}

TEST(SpreadDraws, TheBestHypothesesComeFirstWhereDrawsAreShort) {
  EXPECT_EQ(estimator::spread_draws(9, 3), (Draws{0, 2, 1}));
  EXPECT_EQ(estimator::spread_draws(9, 1), (Draws{0}));
  EXPECT_EQ(estimator::spread_draws(1, 2), (Draws{0, 0}));
}

class LiftAll : public ::testing::Test {
 protected:
  /// The wave's own path with `score`, and the first `share` of it only.
  [[nodiscard]] path::Path wave_path(double share, double score) const {
    path::Path path = path::trace(frame_)->ranked.front();
    const auto kept = static_cast<std::size_t>(share * static_cast<double>(path.points_px.size()));
    path.points_px.resize(kept);
    path.bridged.resize(kept);
    path.score = score;
    return path;
  }
  [[nodiscard]] std::vector<estimator::Hypothesis> lift(std::vector<path::Path> ranked,
                                                        threads::Pool* pool = nullptr) const {
    path::Traversals paths;
    paths.ranked = std::move(ranked);
    paths.rope_width_px = 9;
    auto lifted =
        estimator::lift_all(paths, cloud_, visible_, frame_, weights::PriorKind::kRefined, pool);
    return lifted ? *std::move(lifted) : std::vector<estimator::Hypothesis>{};
  }

  testing::WaveFrame wave_;
  Frame frame_ = wave_.frame();
  evidence::Cloud cloud_ = evidence::unproject(frame_);
  evidence::VisiblePoints visible_ = evidence::visible_points(cloud_);
};

TEST_F(LiftAll, RunnersUpThatCannotBeLiftedAreLeftOut) {
  auto paths = path::trace(frame_);
  ASSERT_TRUE(paths);
  paths->ranked.resize(1);
  path::Path elsewhere;  // off the mask: nothing supports it
  elsewhere.points_px = {{5.0F, 5.0F}, {60.0F, 5.0F}};
  elsewhere.bridged = {0, 0};
  paths->ranked.push_back(elsewhere);
  const auto lifted =
      estimator::lift_all(*paths, cloud_, visible_, frame_, weights::PriorKind::kThesis);
  ASSERT_TRUE(lifted);
  EXPECT_EQ(lifted->size(), 1U);
}

TEST_F(LiftAll, FailsWhenTheBestTraversalCannotBeLifted) {
  path::Traversals paths;
  paths.ranked.resize(1);
  paths.ranked[0].points_px = {{5.0F, 5.0F}, {60.0F, 5.0F}};
  paths.ranked[0].bridged = {0, 0};
  paths.rope_width_px = 9;
  const auto lifted =
      estimator::lift_all(paths, cloud_, visible_, frame_, weights::PriorKind::kThesis);
  ASSERT_FALSE(lifted);
  EXPECT_EQ(lifted.error().code, ErrorCode::kNoEvidence);
}

TEST_F(LiftAll, KindOfPriorIsTheOneAskedFor) {
  const auto paths = path::trace(frame_);
  ASSERT_TRUE(paths);
  const auto thesis =
      estimator::lift_all(*paths, cloud_, visible_, frame_, weights::PriorKind::kThesis);
  const auto refined =
      estimator::lift_all(*paths, cloud_, visible_, frame_, weights::PriorKind::kRefined);
  ASSERT_TRUE(thesis && refined);
  // The refined prior lies behind the surface that the thesis' prior lies on.
  EXPECT_GT(refined->front().prior.nodes[20].z, thesis->front().prior.nodes[20].z);
}

TEST_F(LiftAll, ThreadsChangeNoHypothesis) {
  threads::Pool pool(3);
  const auto paths = [&] {
    return std::vector{wave_path(1.0, -1.0), wave_path(0.9, -1.2), wave_path(0.5, -1.4),
                       wave_path(0.8, -20.0)};
  };
  const auto alone = lift(paths());
  const auto together = lift(paths(), &pool);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(together[i].path, alone[i].path);
    EXPECT_EQ(together[i].score, alone[i].score);
    for (std::size_t k = 0; k < kNodes; ++k) {
      EXPECT_EQ(together[i].prior.nodes[k].z, alone[i].prior.nodes[k].z);
    }
  }
}

TEST_F(LiftAll, HypothesesHaveTheScoresAndTheOrderOfTheirPaths) {
  const auto lifted = lift({wave_path(0.5, -1.0), wave_path(1.0, -1.5)});
  ASSERT_EQ(lifted.size(), 2U);
  EXPECT_EQ(lifted[0].path, 0U);
  EXPECT_EQ(lifted[1].path, 1U);
  EXPECT_EQ(lifted[1].score, -1.5);
  EXPECT_DOUBLE_EQ(estimator::lead(lifted), 0.5);
}

TEST_F(LiftAll, PathsThatExplainTheSameKeepTheirOrder) {
  const auto lifted = lift({wave_path(1.0, -1.0), wave_path(1.0, -1.0), wave_path(1.0, -1.2)});
  ASSERT_EQ(lifted.size(), 3U);
  EXPECT_EQ(lifted[0].path, 0U);
  EXPECT_EQ(lifted[1].path, 1U);
  EXPECT_EQ(lifted[2].path, 2U);
  EXPECT_EQ(estimator::lead(lifted), 0);
}

TEST_F(LiftAll, WhatTrailsHopelesslyIsNotLifted) {
  const auto lifted = lift({wave_path(1.0, 0.0), wave_path(1.0, -estimator::kReach - 0.1)});
  EXPECT_EQ(lifted.size(), 1U);
  EXPECT_EQ(estimator::lead(lifted), estimator::kReach);
}

TEST_F(LiftAll, BothKindsOfPriorHaveThePathsScore) {
  const auto paths = path::trace(frame_);
  ASSERT_TRUE(paths);
  const auto thesis =
      estimator::lift_all(*paths, cloud_, visible_, frame_, weights::PriorKind::kThesis);
  const auto refined =
      estimator::lift_all(*paths, cloud_, visible_, frame_, weights::PriorKind::kRefined);
  ASSERT_TRUE(thesis && refined);
  EXPECT_EQ(thesis->front().score, paths->ranked.front().score);
  EXPECT_EQ(refined->front().score, paths->ranked.front().score);
}

TEST(CourseOf, APathTellsItsGapsInWidths) {
  path::Path path;
  for (int u = 0; u <= 40; ++u) {
    path.points_px.push_back({static_cast<float>(u), 5.0F});
    path.bridged.push_back(u > 10 && u < 20 ? 1 : 0);
  }
  path.hidden_ends = 0.5F;
  path.ring = true;
  const auto course = estimator::course_of(path, 4);
  EXPECT_FLOAT_EQ(course.longest_gap, 2.5F);  // from the last point before to the first after
  EXPECT_FLOAT_EQ(course.bridged, 0.25F);
  EXPECT_EQ(course.hidden_ends, 0.5F);
  EXPECT_TRUE(course.ring);
  EXPECT_FALSE(course.closed);
}

TEST_F(LiftAll, NoMoreThanTwoPathsAreLiftedThatAreTooLongForARope) {
  path::Path there_and_back = wave_path(1.0, -1.0);
  const auto sides = static_cast<std::size_t>(frame_.width + frame_.height);
  const std::vector<Eigen::Vector2f> once = there_and_back.points_px;
  std::vector<Eigen::Vector2f>& points = there_and_back.points_px;
  while (points.size() < estimator::kMostLiftedSides * sides / 2) {
    points.insert(points.end(), once.rbegin(), once.rend());
    points.insert(points.end(), once.begin(), once.end());
  }
  there_and_back.bridged.assign(points.size(), 0);
  EXPECT_EQ(lift({there_and_back, there_and_back, there_and_back}).size(), 2U);
  EXPECT_EQ(lift({there_and_back, wave_path(1.0, -1.0)}).size(), 2U);
}

}  // namespace
}  // namespace flowdlo
