#include "estimator/weights_location.hpp"

#include <gtest/gtest.h>

namespace flowdlo {
namespace {

TEST(DefaultWeights, AreFoundBesideTheProgram) {  // build/<preset>/share/flowdlo/flowdlo.fdw
  const auto found = estimator::default_weights();
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(std::filesystem::canonical(*found),
            std::filesystem::canonical(FLOWDLO_DEFAULT_WEIGHTS));
}

}  // namespace
}  // namespace flowdlo
