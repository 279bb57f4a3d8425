#include "frame/centerline_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace flowdlo::frame {
namespace {

using testing::HasSubstr;

Centerline wavy() {
  Centerline nodes{};
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const auto t = static_cast<float>(j) / 63.0F;
    nodes[j] = {t / 3.0F - 0.1F, t * t / 7.0F, 0.5F + 1.0e-7F * t};
  }
  return nodes;
}

std::string fault_of(const std::string& text) {
  const auto nodes = parse_centerline(text, "truth.csv");
  return nodes ? "" : nodes.error().message;
}

std::string with_row(const std::string& row) {
  auto text = format_centerline(wavy());
  const auto begin = text.find('\n') + 1;
  return text.replace(begin, text.find('\n', begin) - begin, row);
}

TEST(CenterlineCsv, WhatIsWrittenReadsBackBitForBit) {
  const auto nodes = parse_centerline(format_centerline(wavy()), "truth.csv");
  ASSERT_TRUE(nodes) << nodes.error().message;
  EXPECT_EQ(*nodes, wavy());
}

TEST(CenterlineCsv, HasTheHeaderAndSixtyFourRows) {
  const auto text = format_centerline(wavy());
  EXPECT_EQ(text.substr(0, 6), "x,y,z\n");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 65);
}

TEST(CenterlineCsv, OtherLineEndsAndSpacesAreRead) {
  std::string text = "\xEF\xBB\xBFx,y,z\r\n";
  for (int row = 0; row < kNodes; ++row) text += "1, 2 ,3\r\n";
  const auto nodes = parse_centerline(text + "\r\n", "truth.csv");
  ASSERT_TRUE(nodes) << nodes.error().message;
  EXPECT_EQ((*nodes)[63], (Point3{1, 2, 3}));
}

TEST(CenterlineCsv, WrongHeaderIsRefused) {
  EXPECT_THAT(fault_of("a,b,c\n"), HasSubstr("truth.csv: expected the header x,y,z"));
  EXPECT_THAT(fault_of(""), HasSubstr("header"));
}

TEST(CenterlineCsv, OtherThanSixtyFourRowsAreRefused) {
  EXPECT_THAT(fault_of("x,y,z\n1,2,3\n"), HasSubstr("expected 64 rows below the header, got 1"));
  EXPECT_THAT(fault_of(format_centerline(wavy()) + "1,2,3\n"), HasSubstr("got 65"));
}

TEST(CenterlineCsv, BrokenRowsAreNamed) {
  for (const char* row :
       {"1,2", "1,2,3,4", "1,2,nan", "1,inf,3", "1,,3", "a,2,3", "", "1e99,2,3"}) {
    EXPECT_THAT(fault_of(with_row(row)), HasSubstr("truth.csv: line 2: expected three finite"))
        << row;
  }
}

}  // namespace
}  // namespace flowdlo::frame
