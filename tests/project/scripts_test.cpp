// The shell scripts parse, are clean, and can be started.
#include <gmock/gmock.h>
#include <unistd.h>

#include <map>

#include "project/command.hpp"
#include "project/tree.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::project {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// Every bash file, found by its first line.
std::vector<std::string> bash_scripts() {
  auto files = project_files();
  std::erase_if(files,
                [](const auto& path) { return !read(path).starts_with("#!/usr/bin/env bash"); });
  return files;
}

std::string as_arguments(const std::vector<std::string>& files) {
  std::string arguments;
  for (const auto& file : files) {
    arguments += " '" + file + "'";
  }
  return arguments;
}

TEST(Scripts, DemoTestAndContinuousIntegrationAreThere) {
  EXPECT_THAT(bash_scripts(), Contains("scripts/demo"));
  EXPECT_THAT(bash_scripts(), Contains("scripts/test"));
  EXPECT_THAT(bash_scripts(), Contains(".ci/run"));
}

TEST(Scripts, ParseAsBash) {
  for (const auto& script : bash_scripts()) {
    EXPECT_EQ(run("bash -n '" + script + "'").output, "") << script;
  }
}

TEST(Scripts, StopAtTheFirstFailure) {
  for (const auto& script : bash_scripts()) {
    EXPECT_THAT(read(script), HasSubstr("\nset -euo pipefail\n")) << script;
  }
}

TEST(Scripts, ThoseThatPeopleStartAreExecutable) {
  for (const auto& script : bash_scripts()) {
    if (script.starts_with("scripts/") || script.starts_with(".ci/")) {
      EXPECT_EQ(access((test::source_dir() / script).c_str(), X_OK), 0) << script;
    }
  }
}

TEST(Scripts, PassShellcheck) {
  if (!has_program("shellcheck")) {
    GTEST_SKIP() << "shellcheck is not installed";
  }
  EXPECT_EQ(run("shellcheck" + as_arguments(bash_scripts())).output, "");
}

TEST(Packages, StandInOneGroupOnly) {
  std::map<std::string, int> times;
  for (const auto& name :
       lines_of(run("sed 's/#.*//' scripts/packages | awk '{print $2}'").output)) {
    times[name] += name.empty() ? 0 : 1;
  }
  std::erase_if(times, [](const auto& entry) { return entry.second <= 1; });
  EXPECT_THAT(times, IsEmpty());
}

TEST(Install, RefusesAGroupThatIsNotInTheList) {
  if (!has_program("dpkg-query")) {
    GTEST_SKIP() << "not a Debian";
  }
  const auto outcome = run("scripts/install nonsense");

  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, HasSubstr("expected a group of scripts/packages, got \"nonsense\""));
}

}  // namespace
}  // namespace flowdlo::project
