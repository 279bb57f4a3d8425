// Where compiled kernels are kept, by what the environment says.
#include "estimator/cache_folder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace flowdlo {
namespace {

std::string folder_with(const std::map<std::string, std::string>& variables) {
  return estimator::cache_folder([&](const char* name) -> const char* {
           const auto found = variables.find(name);
           return found == variables.end() ? nullptr : found->second.c_str();
         })
      .string();
}

TEST(CacheFolder, IsBelowThatOfTheUser) {
  EXPECT_EQ(folder_with({{"HOME", "/h"}}), "/h/.cache/flowdlo");
  EXPECT_EQ(folder_with({{"HOME", "/h"}, {"XDG_CACHE_HOME", "/c"}}), "/c/flowdlo");
  EXPECT_EQ(folder_with({{"HOME", "/h"}, {"XDG_CACHE_HOME", "c"}}), "/h/.cache/flowdlo");
  EXPECT_EQ(folder_with({}), "");
}

TEST(CacheFolder, CanBeMovedAndSwitchedOff) {
  EXPECT_EQ(folder_with({{"HOME", "/h"}, {"FLOWDLO_CACHE", "/mine"}}), "/mine");
  EXPECT_EQ(folder_with({{"HOME", "/h"}, {"FLOWDLO_CACHE", "off"}}), "");
  EXPECT_EQ(folder_with({{"HOME", "/h"}, {"FLOWDLO_CACHE", ""}}), "/h/.cache/flowdlo");
}

}  // namespace
}  // namespace flowdlo
