// What no file of the project may hold.
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <regex>
#include <set>

#include "project/tree.hpp"

namespace flowdlo::project {
namespace {

using testing::Contains;
using testing::IsEmpty;

constexpr std::size_t kMaxEngineLines = 400;

// The patterns do not match themselves, so that this file is no exception to them.
const std::regex kMachinePath(R"((^|[^\w.}])/(work|root|home|tmp|var/tmp|Users)/)");
const std::regex kRegistryHost(
    R"((pypi|npmjs|rubygems|golang|debian|ubuntu|pythonhosted)[.](org|com|net)\b)"
    R"(|(crates|docker|ghcr|quay|conda)[.]io\b|[a]rtifactory|[l]ocalhost|127[.]0[.]0[.]1)");
const std::regex kPostponed(R"(\b(TO[D]O|FIX[M]E|XX[X])\b)");
const std::regex kTrailingSpace("[ \t\r]$");

using Fault = std::function<bool(const std::string& path, const std::string& content)>;

/// A fuzzer's seeds are bytes, whatever they look like.
bool is_ours(const std::string& path, const std::string& content) {
  return is_text(content) && !path.starts_with("tests/fuzz/seeds/");
}

std::vector<std::string> text_files_with(const Fault& fault) {
  std::vector<std::string> faulty;
  for (const auto& path : project_files()) {
    if (const auto content = read(path); is_ours(path, content) && fault(path, content)) {
      faulty.push_back(path);
    }
  }
  return faulty;
}

/// "path:line: text" for every line of the project's text files that holds `pattern`.
std::vector<std::string> lines_with(const std::regex& pattern,
                                    const std::string& but_not_in = "-") {
  std::vector<std::string> found;
  for (const auto& path : project_files()) {
    const auto content = read(path);
    if (!is_ours(path, content) || path.ends_with(but_not_in)) {
      continue;
    }
    const auto lines = lines_of(content);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], pattern)) {
        found.push_back(path + ":" + std::to_string(i + 1) + ": " + lines[i]);
      }
    }
  }
  return found;
}

TEST(Patterns, FindWhatTheyStandFor) {  // otherwise the tests below would pass on anything
  const std::string slash = "/";
  EXPECT_TRUE(std::regex_search("see " + slash + "home/someone/rope", kMachinePath));
  EXPECT_FALSE(std::regex_search("tests/work/rope.png", kMachinePath));
  EXPECT_TRUE(std::regex_search(std::string("https://") + "pypi" + ".org/simple", kRegistryHost));
  EXPECT_TRUE(std::regex_search(std::string("// TO") + "DO: later", kPostponed));
  EXPECT_TRUE(std::regex_search("int x; ", kTrailingSpace));
}

TEST(Project, FilesAreFound) {
  EXPECT_THAT(project_files(), Contains("tests/project/hygiene_test.cpp"));
}

TEST(Project, NoFileHoldsAMachinePath) { EXPECT_THAT(lines_with(kMachinePath), IsEmpty()); }

TEST(Project, NoFileNamesARegistryHost) { EXPECT_THAT(lines_with(kRegistryHost), IsEmpty()); }

TEST(Project, NothingIsPostponed) { EXPECT_THAT(lines_with(kPostponed), IsEmpty()); }

TEST(Project, NoLineEndsInSpace) { EXPECT_THAT(lines_with(kTrailingSpace, ".md"), IsEmpty()); }

TEST(Project, TextFilesEndInOneNewline) {
  EXPECT_THAT(text_files_with([](const auto& /*path*/, const auto& content) {
                return !content.empty() && (!content.ends_with('\n') || content.ends_with("\n\n"));
              }),
              IsEmpty());
}

TEST(Project, EngineFilesStayShort) {
  EXPECT_THAT(text_files_with([](const auto& path, const auto& content) {
                return path.starts_with("engine/") && lines_of(content).size() > kMaxEngineLines;
              }),
              IsEmpty());
}

TEST(Project, EveryFileIsNamedAfterSomething) {  // house style: one noun a file
  const std::set<std::string> nothing = {"util", "utils", "common", "helper", "helpers", "manager"};
  auto files = project_files();
  std::erase_if(files, [&](const std::string& path) {
    return !nothing.contains(std::filesystem::path(path).stem().string());
  });
  EXPECT_THAT(files, IsEmpty());
}

}  // namespace
}  // namespace flowdlo::project
