// The kernels compiled for newer processors keep their code to themselves: an inline function
// compiled for AVX-512 that the linker picks for the whole program ends it on an older machine.
#include <gmock/gmock.h>

#include "project/command.hpp"
#include "project/tree.hpp"

namespace flowdlo::project {
namespace {

using testing::IsEmpty;

const std::string kObjects = FLOWDLO_VECTOR_OBJECTS;  // separated by spaces

TEST(VectorCode, SharesNoFunctionWithTheRestOfTheProgram) {
  if (kObjects.empty() || !has_program("nm")) {
    GTEST_SKIP() << "no kernels for newer processors in this build, or no nm";
  }
  auto shared =
      lines_of(run("nm -C --defined-only " + kObjects + " | grep -E '^[^ ]+ [WVu] '").output);
  std::erase_if(shared, [](const std::string& line) {
    return line.find("_avx2::") != std::string::npos ||
           line.find("::avx2::") != std::string::npos ||
           line.find("_avx512::") != std::string::npos ||
           line.find("::avx512::") != std::string::npos ||
           line.find(" DW.ref.") != std::string::npos;  // data: the exception personality
  });
  EXPECT_THAT(shared, IsEmpty());
}

}  // namespace
}  // namespace flowdlo::project
