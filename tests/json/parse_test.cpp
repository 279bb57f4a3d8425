#include "json/parse.hpp"

#include <gmock/gmock.h>

namespace flowdlo::json {
namespace {

using ::testing::ElementsAre;
using Kind = Value::Kind;

Value value_of(const char* text) {
  const Parsed parsed = parse(text);
  EXPECT_TRUE(parsed.fine) << text;
  return parsed.value;
}

TEST(JsonParse, PlainValuesAreWhatTheySay) {
  EXPECT_EQ(value_of("null").kind, Kind::kNull);
  EXPECT_EQ(value_of("true").number, 1);
  EXPECT_EQ(value_of("-2.5e1").number, -25);
  EXPECT_EQ(value_of("\"a\\nb\"").string, "a\nb");
  EXPECT_TRUE(value_of("7").whole);
  EXPECT_TRUE(value_of("-7").whole);
  EXPECT_FALSE(value_of("7.0").whole);
}

TEST(JsonParse, ArraysKeepTheirOrderAndObjectsAreFoundByKey) {
  const Value value = value_of(R"({"z": [1, [2, 3], "x"], "a": {"b": null}})");
  ASSERT_NE(value.find("z"), nullptr);
  const auto& z = value.find("z")->elements;
  ASSERT_EQ(z.size(), 3U);
  EXPECT_EQ(z[1].elements[1].number, 3);
  EXPECT_EQ(z[2].string, "x");
  ASSERT_NE(value.find("a"), nullptr);
  EXPECT_NE(value.find("a")->find("b"), nullptr);
  EXPECT_EQ(value.find("b"), nullptr);
  EXPECT_EQ(z[0].find("a"), nullptr) << "a number has no members";
}

TEST(JsonParse, OfAKeyGivenTwiceTheLastCountsAndItIsNoted) {
  const Parsed parsed = parse(R"({"b": 1, "a": 2, "b": 3, "c": {"d": 1, "d": 2}, "b": 4})");
  ASSERT_TRUE(parsed.fine);
  EXPECT_EQ(parsed.value.find("b")->number, 4);
  EXPECT_EQ(parsed.value.members.size(), 3U);
  EXPECT_THAT(parsed.twice, ElementsAre("b", "d"));
}

TEST(JsonParse, DepthIsToldAndWhatLiesTooDeepIsReadOver) {
  EXPECT_EQ(parse("1").depth, 0);
  EXPECT_EQ(parse("[{}]").depth, 2);
  constexpr int kMany = 200000;
  const Parsed deep = parse(std::string(kMany, '[') + "1" + std::string(kMany, ']'));
  ASSERT_TRUE(deep.fine);
  EXPECT_EQ(deep.depth, kMany);
  const Value* inner = &deep.value;
  for (int level = 1; level <= kDeepest; ++level) {
    ASSERT_EQ(inner->elements.size(), 1U);
    inner = &inner->elements[0];
  }
  EXPECT_TRUE(inner->is_array());
  EXPECT_TRUE(inner->elements.empty());
  const Parsed object = parse(R"([[[[[[[[[[[[[[[[{"a": {"b": 1}}, 5]]]]]]]]]]]]]]]])");
  EXPECT_TRUE(object.fine);
}

TEST(JsonParse, WhatIsNoJsonIsTold) {
  EXPECT_FALSE(parse("").fine);
  EXPECT_FALSE(parse("{\"a\": NaN}").fine);
  EXPECT_FALSE(parse("[1, 2").fine);
  EXPECT_FALSE(parse("\"\xff\"").fine);
  const Parsed parsed = parse("[1,\n 2,\n oh]");
  EXPECT_FALSE(parsed.fine);
  EXPECT_GE(parsed.fault_at, 9U);
  EXPECT_FALSE(parsed.too_large);
}

TEST(JsonParse, ANumberThatNoDoubleHoldsIsTold) {
  const Parsed parsed = parse("[1e999]");
  EXPECT_FALSE(parsed.fine);
  EXPECT_TRUE(parsed.too_large);
}

}  // namespace
}  // namespace flowdlo::json
