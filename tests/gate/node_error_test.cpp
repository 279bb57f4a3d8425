#include "gate/node_error.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace flowdlo::gate {
namespace {

using Numbers = std::array<double, NodeError::kNumbers>;

// 1 mm on the right strand; elsewhere, as likely as not, 100 mm.
const Numbers kEither{std::log(0.001), std::log(0.1), 0, -1, -1};

TEST(NodeError, HalfOfOnePartLiesWithinItsMedian) {
  const NodeError error(Numbers{std::log(0.002), 0, -50, -1, -1});
  EXPECT_NEAR(error.within(std::log(0.002)), 0.5, 1e-9);
  EXPECT_NEAR(error.quantile_m(0.5), 0.002, 1e-8);
}

TEST(NodeError, AsManyAreWithinAQuantileAsItSays) {
  const NodeError error(kEither);
  for (const double share : {0.1, 0.45, 0.55, 0.68, 0.95}) {
    EXPECT_NEAR(error.within(std::log(error.quantile_m(share))), share, 1e-6);
  }
}

TEST(NodeError, WhatIsPerhapsElsewhereReachesAsFar) {
  const NodeError sure(Numbers{kEither[0], kEither[1], -6, kEither[3], kEither[4]});
  EXPECT_LT(sure.quantile_m(0.9), 0.003);
  EXPECT_GT(NodeError(kEither).quantile_m(0.9), 0.1);
}

TEST(NodeError, TheSlopeIsThatOfTheDensity) {
  constexpr double kStep = 1e-6;
  for (const double log_m : {-8.0, -5.0, -2.5}) {
    Numbers slope{};
    Numbers unused{};
    (void)NodeError(kEither).log_density(log_m, slope);
    for (std::size_t k = 0; k < slope.size(); ++k) {
      Numbers more = kEither;
      Numbers less = kEither;
      more[k] += kStep;
      less[k] -= kStep;
      const double rise =
          NodeError(more).log_density(log_m, unused) - NodeError(less).log_density(log_m, unused);
      EXPECT_NEAR(slope[k], rise / (2 * kStep), 1e-5);
    }
  }
}

TEST(NodeError, IsAsLargeAsItGetsWhereWhatWasSaidIsNotFinite) {
  Numbers said = kEither;
  said[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(NodeError(said).quantile_m(0.9), NodeError::kMost_m, 1e-6);
}

}  // namespace
}  // namespace flowdlo::gate
