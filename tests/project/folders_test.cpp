// Which of the folders around the engine sees which: support/ is a leaf, tools/ and lab/ stand on
// it, and neither of these sees the other, in its #includes or in what it links. support/ and
// tools/ see nothing of OpenCV either, which brings half of what a bare system would have to
// install.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "project/include_rules.hpp"
#include "project/tree.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::project {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

using Folders = std::vector<std::string>;

/// What each may see beside itself, the engine and the public headers, and what it may not.
struct Rule {
  Folders seen;
  Folders unseen;
};
const std::map<std::string, Rule> kRules = {
    {"support", {{}, {"tools", "lab"}}},
    {"tools", {{"support"}, {"lab"}}},
    {"lab", {{"support"}, {"tools"}}},
};

std::string folder_of(const std::string& path) { return path.substr(0, path.find('/')); }

/// Whether `target`, included by `file`, is a file below `folder`: written from there, or by dots.
bool lies_in(const std::string& folder, const std::string& file, const std::string& target,
             const std::set<std::string>& files) {
  const auto by_dots = (fs::path(file).parent_path() / target).lexically_normal().string();
  return files.contains(folder + "/" + target) ||
         (files.contains(by_dots) && folder_of(by_dots) == folder);
}

/// Why `file` must not have `include`; empty where it may. `files`: all of the project's.
std::string complaint_of(const std::string& file, const Include& include,
                         const std::set<std::string>& files) {
  const auto own = folder_of(file);
  const Rule& rule = kRules.at(own);
  Folders seen = rule.seen;
  seen.insert(seen.end(), {own, "engine", "include"});
  for (const auto& folder : seen) {
    if (lies_in(folder, file, include.target, files)) return {};
  }
  for (const auto& folder : rule.unseen) {
    if (lies_in(folder, file, include.target, files)) {
      return file + ": includes \"" + include.target + "\" of " + folder + "/, which " + own +
             "/ does not see";
    }
  }
  return {};
}

std::string without_comments(const std::string& cmake) {
  return std::regex_replace(cmake, std::regex("#[^\n]*"), "");
}

std::set<std::string> targets_of(const std::string& cmake) {
  static const std::regex added(R"(add_(?:library|executable)\((\w+))");
  std::set<std::string> names;
  for (std::sregex_iterator it(cmake.begin(), cmake.end(), added), end; it != end; ++it) {
    names.insert((*it)[1]);
  }
  return names;
}

std::set<std::string> words_of(const std::string& text) {
  static const std::regex word(R"(\w+)");
  return {std::sregex_token_iterator(text.begin(), text.end(), word), std::sregex_token_iterator()};
}

/// The CMake lists below `folder`, without comments, one after another.
std::string lists_of(const std::string& folder) {
  std::string all;
  for (const auto& path : project_files()) {
    if (folder_of(path) == folder && path.ends_with("CMakeLists.txt")) {
      all += without_comments(read(path)) + "\n";
    }
  }
  return all;
}

const std::set<std::string> kFew = {"support/progress_bar.hpp", "tools/overlay.hpp",
                                    "lab/eval/trial.hpp", "lab/eval/overlay.cpp"};

TEST(FolderRules, SupportIsSeenByBothAndSeesNeither) {
  EXPECT_EQ(complaint_of("lab/eval/overlay.cpp", {"progress_bar.hpp"}, kFew), "");
  EXPECT_EQ(complaint_of("tools/overlay.hpp", {"progress_bar.hpp"}, kFew), "");
  EXPECT_THAT(complaint_of("support/progress_bar.hpp", {"overlay.hpp"}, kFew),
              HasSubstr("of tools/, which support/ does not see"));
  EXPECT_THAT(complaint_of("support/progress_bar.hpp", {"eval/trial.hpp"}, kFew),
              HasSubstr("of lab/"));
}

TEST(FolderRules, ToolsAndLabDoNotSeeEachOther) {
  EXPECT_THAT(complaint_of("lab/eval/overlay.cpp", {"overlay.hpp"}, kFew), HasSubstr("of tools/"));
  EXPECT_THAT(complaint_of("lab/eval/overlay.cpp", {"../../tools/overlay.hpp"}, kFew),
              HasSubstr("of tools/"));
  EXPECT_THAT(complaint_of("tools/overlay.hpp", {"eval/trial.hpp"}, kFew), HasSubstr("of lab/"));
  EXPECT_EQ(complaint_of("tools/overlay.hpp", {"vector", true}, kFew), "");
}

class FoldersAroundTheEngine : public testing::TestWithParam<std::string> {};

TEST_P(FoldersAroundTheEngine, IncludeOnlyWhatTheySee) {
  const auto all = project_files();
  const std::set<std::string> files(all.begin(), all.end());
  std::vector<std::string> complaints;
  int sources = 0;
  for (const auto& path : all) {
    const bool is_source = path.ends_with(".hpp") || path.ends_with(".cpp");
    if (folder_of(path) != GetParam() || !is_source) continue;
    ++sources;
    for (const auto& include : includes_of(read(path))) {
      if (include.angled) continue;
      if (auto words = complaint_of(path, include, files); !words.empty()) {
        complaints.push_back(words);
      }
    }
  }
  EXPECT_GT(sources, 10);
  EXPECT_THAT(complaints, IsEmpty());
}

TEST_P(FoldersAroundTheEngine, LinkOnlyWhatTheySee) {
  const auto lists = lists_of(GetParam());
  const auto used = words_of(lists);
  EXPECT_THAT(targets_of(lists), Not(IsEmpty()));
  for (const auto& folder : kRules.at(GetParam()).unseen) {
    EXPECT_THAT(lists, Not(HasSubstr("/" + folder + "/"))) << "a path to " << folder;
    EXPECT_THAT(lists, Not(HasSubstr("/" + folder + "\""))) << "a path to " << folder;
    for (const auto& target : targets_of(lists_of(folder))) {
      EXPECT_THAT(used, Not(Contains(target))) << "a target of " << folder;
    }
  }
}

TEST(FoldersOfTheCommand, HaveNothingOfOpenCV) {
  for (const std::string folder : {"support", "tools"}) {
    EXPECT_THAT(lists_of(folder), Not(testing::ContainsRegex("[oO]pen[cC][vV]|mat/"))) << folder;
  }
  for (const auto& path : project_files()) {
    if (folder_of(path) != "support" && folder_of(path) != "tools") continue;
    for (const auto& include : includes_of(read(path))) {
      EXPECT_FALSE(include.target.starts_with("opencv") || include.target.starts_with("mat/"))
          << path << ": " << include.target;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Folders, FoldersAroundTheEngine,
                         testing::Values("support", "tools", "lab"),
                         [](const auto& of) { return of.param; });

}  // namespace
}  // namespace flowdlo::project
