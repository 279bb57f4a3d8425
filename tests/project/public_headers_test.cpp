// include/flowdlo/ asks nothing of its reader but the standard library; one header, which no other
// includes, asks for Vulkan's as well.
#include <gmock/gmock.h>

#include <regex>

#include "project/include_rules.hpp"
#include "project/tree.hpp"

namespace flowdlo::project {
namespace {

using testing::IsEmpty;
using testing::Not;

constexpr const char* kOfVulkan = "include/flowdlo/vulkan.hpp";

std::vector<std::string> public_headers() {
  auto files = project_files();
  std::erase_if(files, [](const auto& path) { return !path.starts_with("include/"); });
  return files;
}

TEST(PublicHeaders, IncludeOnlyTheStandardLibraryAndEachOther) {
  std::vector<std::string> others;
  for (const auto& header : public_headers()) {
    for (const auto& include : includes_of(read(header))) {
      const bool of_vulkan = header == kOfVulkan && include.target == "vulkan/vulkan_core.h";
      if (include.target == "flowdlo/vulkan.hpp") others.push_back(header + ": " + include.target);
      const bool standard =
          include.angled && include.target.find_first_of("/.") == std::string::npos;
      const bool of_c = header.ends_with(".h") && include.angled &&
                        (include.target == "stddef.h" || include.target == "stdint.h");
      if (!standard && !of_c && !of_vulkan && !include.target.starts_with("flowdlo/")) {
        others.push_back(header + ": " + include.target);
      }
    }
  }
  EXPECT_THAT(public_headers(), Not(IsEmpty()));
  EXPECT_THAT(others, IsEmpty());
}

TEST(PublicHeaders, OfCppThatTheCHeaderIncludesHoldDirectivesOnly) {
  std::vector<std::string> code;
  for (const auto& include : includes_of(read("include/flowdlo/flowdlo.h"))) {
    if (!include.target.ends_with(".hpp")) {
      continue;
    }
    const auto file = "include/" + include.target;
    const bool generated = include.target == "flowdlo/version.hpp";
    const auto content = read(generated ? file + ".in" : file);
    EXPECT_FALSE(content.empty()) << file;
    for (const auto& line : lines_of(content)) {
      if (!line.empty() && !line.starts_with('#') && !line.starts_with("//")) {
        code.push_back(file + ": " + line);
      }
    }
  }
  EXPECT_THAT(code, IsEmpty());
}

TEST(PublicHeaders, NameNoThirdPartyType) {
  const std::regex foreign(
      R"(\b(Vk[A-Z]\w*|vk[A-Z]\w*|(vk|cv|Eigen|flatbuffers|nlohmann|fmt|tbb|oneapi|CLI)::))");
  std::vector<std::string> named;
  for (const auto& header : public_headers()) {
    if (header == kOfVulkan) continue;
    const auto content = read(header);
    if (std::smatch match; std::regex_search(content, match, foreign)) {
      named.push_back(header + ": " + match.str());
    }
  }
  EXPECT_THAT(named, IsEmpty());
}

// Clang 14 takes [[nodiscard]] behind a compiler's own attribute for one of the type.
TEST(PublicHeaders, HaveStandardAttributesBeforeTheCompilersOwn) {
  const std::regex behind(R"(FLOWDLO_[A-Z]+\s+\[\[\w+)");
  EXPECT_TRUE(std::regex_search("FLOWDLO_HIDDEN [[nodiscard]] int f();", behind));
  std::vector<std::string> found;
  for (const auto& header : public_headers()) {
    const auto content = read(header);
    if (std::smatch match; std::regex_search(content, match, behind)) {
      found.push_back(header + ": " + match.str());
    }
  }
  EXPECT_THAT(found, IsEmpty());
}

}  // namespace
}  // namespace flowdlo::project
