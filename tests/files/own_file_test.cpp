#include "files/own_file.hpp"

#include <gtest/gtest.h>
#include <sys/auxv.h>

#include <filesystem>

namespace flowdlo::files {
namespace {

namespace fs = std::filesystem;

TEST(OwnFile, TheRunningProgramIsTheOneThatTheSystemBegan) {
  const fs::path program = running_program();
  EXPECT_TRUE(program.is_absolute());
  EXPECT_EQ(program, fs::canonical("/proc/self/exe"));
  // What it falls back on where /proc is not there.
  const auto* const name = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  EXPECT_EQ(program_that_began_as(name), program);
}

TEST(OwnFile, ANameThatIsNoFileNamesNoProgram) {
  EXPECT_TRUE(program_that_began_as(nullptr).empty());
  EXPECT_TRUE(program_that_began_as("no/such/program").empty());
}

}  // namespace
}  // namespace flowdlo::files
