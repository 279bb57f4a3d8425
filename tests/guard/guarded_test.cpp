#include "guard/guarded.hpp"

#include <gmock/gmock.h>

#include <new>
#include <stdexcept>
#include <string>

namespace flowdlo::guard {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

template <class Thrown>
Error error_of(const Thrown& thrown) {
  return guarded("here", [&]() -> Result<int> { throw thrown; }).error();
}

TEST(Guarded, PassesOnWhatIsGiven) {
  EXPECT_EQ(*guarded("here", [] { return Result<int>(7); }), 7);
  const auto refused = guarded("here", []() -> Result<int> { return Error{ErrorCode::kIo, "no"}; });
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
}

TEST(Guarded, MemoryThatRanOutIsItsOwnCode) {
  const Error error = error_of(std::bad_alloc());
  EXPECT_EQ(error.code, ErrorCode::kOutOfMemory);
  EXPECT_THAT(error.message, StartsWith("here: "));
  EXPECT_STREQ(name_of(error.code), "out_of_memory");
}

TEST(Guarded, AnArrayThatFoundNoMemoryIsTheSame) {
  EXPECT_EQ(error_of(std::bad_array_new_length()).code, ErrorCode::kOutOfMemory);
}

TEST(Guarded, AFailureIsItsErrorWordForWord) {
  const Error error = error_of(Failure({ErrorCode::kDeviceLost, "the device went away"}));
  EXPECT_EQ(error.code, ErrorCode::kDeviceLost);
  EXPECT_EQ(error.message, "the device went away");
}

TEST(Guarded, AnyOtherExceptionIsADefectOfOurs) {
  for (const Error& error :
       {error_of(std::logic_error("odd")), error_of(std::runtime_error("odd"))}) {
    EXPECT_EQ(error.code, ErrorCode::kInternal);
    EXPECT_THAT(error.message, HasSubstr("odd"));
  }
}

}  // namespace
}  // namespace flowdlo::guard
