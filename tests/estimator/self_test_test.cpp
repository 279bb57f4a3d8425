#include "estimator/self_test.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/faulty_program.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;

using testing::FaultyProgram;

estimator::Verdict verdict_on(FaultyProgram::Fault fault) {
  return estimator::self_test([fault] { return std::make_unique<FaultyProgram>(fault); });
}

TEST(SelfTest, PassesOnTheCpuBackEnd) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kNone);
  EXPECT_TRUE(verdict.passed) << verdict.text;
}

TEST(SelfTest, FailsWhenOneNodeIsAMillimetreOff) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kWrongNumbers);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.text, HasSubstr("1 mm"));
}

TEST(SelfTest, FailsWhenOtherPointsArePicked) {
  EXPECT_FALSE(verdict_on(FaultyProgram::Fault::kOtherPoints).passed);
}

TEST(SelfTest, FailsWhenTheStrandFieldSeesSomethingElse) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kWrongField);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.text, HasSubstr("strand field"));
}

TEST(SelfTest, FailsWithTheDevicesOwnSentence) {
  const auto verdict = verdict_on(FaultyProgram::Fault::kLost);
  EXPECT_FALSE(verdict.passed);
  EXPECT_THAT(verdict.text, HasSubstr("the device went away"));
}

}  // namespace
}  // namespace flowdlo
