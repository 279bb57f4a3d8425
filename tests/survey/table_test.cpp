#include "survey/table.hpp"

#include <gtest/gtest.h>

namespace flowdlo::survey {
namespace {

TEST(Table, RowsHaveTheHeadersWidth) {
  Table table({"a", "b"});
  table.add({"1"});
  table.add({"1", "2", "3"});
  EXPECT_EQ(table.text(), "| a | b |\n|---|---|\n| 1 | |\n| 1 | 2 |\n\n");
}

}  // namespace
}  // namespace flowdlo::survey
