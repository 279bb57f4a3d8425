// The shared library from outside: what it exports, and what it links.
#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "project/command.hpp"
#include "project/tree.hpp"

namespace flowdlo::project {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kLibrary = FLOWDLO_SHARED_LIBRARY;
const std::string kSanitize = FLOWDLO_SANITIZE;

class SharedLibrary : public testing::Test {
 protected:
  void SetUp() override {
    if (kLibrary.empty() || !kSanitize.empty()) {
      GTEST_SKIP() << "flowdlo is static or sanitized in this build";
    }
    if (!has_program("nm") || !has_program("readelf")) {
      GTEST_SKIP() << "nm and readelf are not installed";
    }
  }

  /// Demangled names of the dynamic symbols that the library defines.
  static std::vector<std::string> exports() {
    const auto names = run("nm -D -C --defined-only '" + kLibrary + "' | cut -d' ' -f3-");
    return lines_of(names.output);
  }
};

/// The functions that the C header declares.
std::set<std::string> c_functions() {
  static const std::regex declared(R"(FLOWDLO_EXPORT[^;(]*\b(flowdlo_\w+)\()");
  const auto header = read("include/flowdlo/flowdlo.h");
  std::set<std::string> names;
  for (std::sregex_iterator it(header.begin(), header.end(), declared), end; it != end; ++it) {
    names.insert((*it)[1]);
  }
  return names;
}

bool is_ours(std::string name) {
  if (c_functions().contains(name)) {
    return true;
  }
  for (const std::string prefix : {"typeinfo for ", "typeinfo name for ", "vtable for "}) {
    if (name.starts_with(prefix)) {
      name.erase(0, prefix.size());
    }
  }
  return name.starts_with("flowdlo::");
}

TEST_F(SharedLibrary, ExportsTheEstimator) {
  EXPECT_THAT(exports(), Contains(HasSubstr("flowdlo::Estimator::create")));
}

TEST_F(SharedLibrary, ExportsEveryFunctionOfTheCHeader) {
  const auto all = exports();
  EXPECT_THAT(c_functions(), Contains("flowdlo_estimator_estimate"));
  for (const auto& name : c_functions()) {
    EXPECT_THAT(all, Contains(name));
  }
}

TEST_F(SharedLibrary, ExportsNothingButItsOwnNames) {
  auto foreign = exports();
  std::erase_if(foreign, is_ours);
  EXPECT_THAT(foreign, IsEmpty());
}

TEST_F(SharedLibrary, ExportsNothingOfItsRooms) {
  auto inner = exports();
  std::erase_if(inner, [](const auto& name) {
    if (name.find("flowdlo::") == std::string::npos) {
      return true;  // of C
    }
    const auto first = name.find("flowdlo::") + 9;
    const char initial = first < name.size() ? name[first] : 'A';
    const auto scope = name.find("::", first);
    const auto parenthesis = name.find('(', first);
    return !(initial >= 'a' && initial <= 'z' && scope < parenthesis);  // flowdlo::room::thing(
  });
  EXPECT_THAT(inner, IsEmpty());
}

TEST_F(SharedLibrary, ExportsNothingThatOnlyItsOwnSourcesCanCall) {
  EXPECT_THAT(exports(), Not(Contains(HasSubstr("Estimator::Impl"))));
}

TEST_F(SharedLibrary, LinksTheSystemLibpngAndZlibAlone) {
  const auto needed = lines_of(
      run("readelf -d '" + kLibrary + "' | sed -n 's/.*NEEDED.*\\[\\(.*\\)\\]/\\1/p'").output);
  EXPECT_THAT(needed, Contains(HasSubstr("libc.so")));
  for (const auto& name : needed) {
    static const std::regex allowed(
        R"((libc|libm|libdl|libpthread|libstdc\+\+|libgcc_s|libpng\d*|libz|ld-linux[-\w]*)\.so.*)");
    EXPECT_TRUE(std::regex_match(name, allowed)) << name;
  }
}

TEST_F(SharedLibrary, HasNothingToDoWithAnotherOpenCvInTheProcess) {
  const std::string nodes = "'" FLOWDLO_NODES_PROGRAM "' examples/frames/overhand_loop";
  const auto alone = run(nodes);
  const auto beside = run("LD_PRELOAD='" FLOWDLO_OTHER_OPENCV "' " + nodes);
  EXPECT_EQ(alone.status, 0) << alone.output;
  EXPECT_EQ(beside.status, 0) << beside.output;
  EXPECT_EQ(lines_of(alone.output).size(), 64U);
  EXPECT_EQ(alone.output, beside.output);
}

TEST_F(SharedLibrary, OpensTheVulkanLoaderInsteadOfLinkingIt) {
  EXPECT_THAT(run("readelf -d '" + kLibrary + "'").output, Not(HasSubstr("libvulkan")));
}

}  // namespace
}  // namespace flowdlo::project
