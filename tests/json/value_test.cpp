#include "json/value.hpp"

#include <gtest/gtest.h>

#include "json/parse.hpp"

namespace flowdlo::json {
namespace {

std::string again(const char* text) { return text_of(parse(text).value); }

TEST(JsonValue, IsWrittenAsItWasRead) {
  for (const char* text : {"null", "true", "false", "5", "-5", "5.0", "0.001", "\"a\\\"b\"",
                           "[1,2.5,\"x\"]", "{\"a\":1,\"b\":[]}", "[]", "{}"}) {
    EXPECT_EQ(again(text), text);
  }
}

TEST(JsonValue, WhatIsNestedIsLeftOut) { EXPECT_EQ(again("[[1],{\"a\":2}]"), "[[],{}]"); }

TEST(JsonValue, ANumberBeyondWhatADoubleHoldsExactlyIsRounded) {
  EXPECT_EQ(again("18446744073709551615"), "1.8446744073709552e+19");
}

TEST(JsonValue, TextIsQuotedInAscii) {
  EXPECT_EQ(escaped("a\"b\n"), R"("a\"b\n")");
  EXPECT_EQ(escaped("\xC3\xA4"), R"("\u00e4")");
  EXPECT_EQ(escaped("\xff"), R"("\ufffd")");
}

}  // namespace
}  // namespace flowdlo::json
