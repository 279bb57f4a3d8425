// The documents keep up with the tree: links lead somewhere, quoted code is the code.
#include <gmock/gmock.h>

#include <filesystem>
#include <ostream>
#include <regex>

#include "project/tree.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::project {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> documents() {
  auto files = project_files();
  std::erase_if(files, [](const auto& path) { return !path.ends_with(".md"); });
  return files;
}

/// Contents of the blocks of `markdown` fenced as `language`.
std::vector<std::string> blocks(const std::string& markdown, const std::string& language) {
  std::vector<std::string> found;
  const std::string fence = "```" + language + "\n";
  for (auto at = markdown.find(fence); at != std::string::npos; at = markdown.find(fence, at)) {
    at += fence.size();
    found.push_back(markdown.substr(at, markdown.find("```", at) - at));
  }
  return found;
}

std::string without_indents(const std::string& code) {
  static const std::regex indent("(^|\\n) +");
  return std::regex_replace(code, indent, "$1");
}

TEST(Documents, LinksLeadToFilesOfTheProject) {
  const std::regex link(R"(\]\(([^)#:\s]+)(#[^)]*)?\))");
  std::vector<std::string> dead;
  for (const auto& document : documents()) {
    const auto content = read(document);
    for (std::sregex_iterator it(content.begin(), content.end(), link), end; it != end; ++it) {
      const auto target = fs::path(document).parent_path() / (*it)[1].str();
      if (!fs::exists(test::source_dir() / target)) {
        dead.push_back(document + ": " + target.generic_string());
      }
    }
  }
  EXPECT_THAT(documents(), Not(IsEmpty()));
  EXPECT_THAT(dead, IsEmpty());
}

TEST(Readme, BeginsWithTheTwoCommands) {
  const auto lines = lines_of(read("README.md"));
  const auto top = std::vector(lines.begin(), lines.begin() + std::min<long>(8, std::ssize(lines)));
  EXPECT_THAT(top, testing::Contains(HasSubstr("scripts/demo")));
  EXPECT_THAT(top, testing::Contains(HasSubstr("scripts/test")));
}

/// The blocks of a document in one language, and the files that hold them, in order.
struct Quotation {
  std::string document;
  std::string language;
  std::vector<std::string> sources;
};

void PrintTo(const Quotation& quotation, std::ostream* out) { *out << quotation.document; }

class Quotations : public testing::TestWithParam<Quotation> {};

TEST_P(Quotations, AreOfCodeThatIsBuiltAndRun) {
  const auto& [document, language, sources] = GetParam();
  const auto quoted = blocks(read(document), language);

  ASSERT_EQ(quoted.size(), sources.size());
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    EXPECT_THAT(without_indents(read(sources[i])), HasSubstr(without_indents(quoted[i])));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Documents, Quotations,
    testing::Values(
        Quotation{"README.md", "cpp", {"examples/estimate_one_frame.cpp"}},
        Quotation{"docs/c.md", "c", {"examples/estimate_one_frame.c", "tests/c_api/c99_caller.c"}}),
    [](const auto& of) { return "In" + std::to_string(of.index); });

}  // namespace
}  // namespace flowdlo::project
