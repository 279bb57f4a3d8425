#include "report/base64.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace flowdlo::report {
namespace {

std::string coded(const std::string& text) {
  return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
}

TEST(Base64, IsThatOfItsStandard) {  // RFC 4648, section 10
  EXPECT_EQ(coded(""), "");
  EXPECT_EQ(coded("f"), "Zg==");
  EXPECT_EQ(coded("fo"), "Zm8=");
  EXPECT_EQ(coded("foo"), "Zm9v");
  EXPECT_EQ(coded("foobar"), "Zm9vYmFy");
}

TEST(Base64, TakesEveryByte) { EXPECT_EQ(coded("\xff\xfe"), "//4="); }

}  // namespace
}  // namespace flowdlo::report
