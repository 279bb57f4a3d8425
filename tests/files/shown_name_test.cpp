#include "files/shown_name.hpp"

#include <gtest/gtest.h>

namespace flowdlo::files {
namespace {

TEST(ShownName, OrdinaryTextIsAsItWas) {
  for (const char* text : {"", "rope", "a b/c\\x.bag",
                           "Stra\xC3\x9F"
                           "e",
                           "\xE7\xB8\x84", "\xF0\x9F\xAA\xA2"}) {
    EXPECT_EQ(shown(text), text);
    EXPECT_EQ(shown_lines(text), text);
  }
}

TEST(ShownName, ControlCharactersAreWrittenOut) {
  EXPECT_EQ(shown("\x1B[2J"), "\\x1b[2J");
  EXPECT_EQ(shown("a\rb\x7F"), "a\\x0db\\x7f");
  EXPECT_EQ(shown(std::string("\0", 1)), "\\x00");
  EXPECT_EQ(shown("\xC2\x9B"), "\\xc2\\x9b") << "CSI of C1";
  EXPECT_EQ(shown("\xE2\x80\xAE"), "\\xe2\\x80\\xae") << "right to left";
}

TEST(ShownName, LineEndsStayOnlyInLines) {
  EXPECT_EQ(shown("rope\nall is well\t"), "rope\\x0aall is well\\x09");
  EXPECT_EQ(shown_lines("one\ntwo\t\x1B"), "one\ntwo\t\\x1b");
}

TEST(ShownName, WhatIsNoUtf8IsWrittenOut) {
  EXPECT_EQ(shown("\xFF"), "\\xff");
  EXPECT_EQ(shown("\xC3"), "\\xc3") << "ends early";
  EXPECT_EQ(shown("\xC0\x9B"), "\\xc0\\x9b") << "overlong";
  EXPECT_EQ(shown("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(shown("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(ShownName, OfAPathIsThatOfItsBytes) {
  EXPECT_EQ(shown(std::filesystem::path("a") / "b\n"), "a/b\\x0a");
}

}  // namespace
}  // namespace flowdlo::files
