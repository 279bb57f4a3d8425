#include "eval/method_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "eval/scenes.hpp"

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;

TEST(MethodRows, AFailedMethodKeepsItsRowAndReason) {
  const std::vector<Trial> trials{test::scene_without_baseline("a, b", "C")};
  const std::string rows = method_rows_csv(trials);
  EXPECT_THAT(rows, HasSubstr("set,\"a, b\",C,trackdlo,0,0,cost of two tips is not a number,1,0,"
                              "0.0000,,,,,\n"));
  EXPECT_THAT(rows, HasSubstr("set,\"a, b\",C,full,1,1,,4,2,0.7500,3.00000,6.00000,3.00000,"));
}

TEST(MethodRows, EveryRowHasTheHeadersFields) {
  const std::vector<Trial> trials{test::scene("a", "C"), test::real_frame("b")};
  const std::string rows = method_rows_csv(trials);
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t end = rows.find('\n', at);
    EXPECT_EQ(std::count(rows.begin() + static_cast<long>(at),
                         rows.begin() + static_cast<long>(end), ','),
              14);
    at = end + 1;
  }
}

}  // namespace
}  // namespace flowdlo::eval
