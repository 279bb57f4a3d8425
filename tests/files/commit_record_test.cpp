#include "files/commit_record.hpp"

#include <gtest/gtest.h>

namespace flowdlo::files {
namespace {

CommitRecord sample() {
  return {"camera.json",
          {{".flowdlo-0123456789abcdef.part", "depth.png"},
           {".flowdlo-fedcba9876543210.part", "camera.json"}},
          {"color.png"}};
}

TEST(CommitRecord, WhatIsWrittenReadsBack) {
  const auto record = parse_record(format_record(sample()));
  ASSERT_TRUE(record);
  EXPECT_EQ(record->key, "camera.json");
  ASSERT_EQ(record->puts.size(), 2);
  EXPECT_EQ(record->put_of("depth.png")->temporary, ".flowdlo-0123456789abcdef.part");
  EXPECT_EQ(record->put_of("mask.png"), nullptr);
  EXPECT_TRUE(record->removes_name("color.png"));
  EXPECT_FALSE(record->removes_name("depth.png"));
}

TEST(CommitRecord, CutAnywhereIsNone) {
  const std::string whole = format_record(sample());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_record(whole.substr(0, size))) << size;
  }
  EXPECT_FALSE(parse_record(whole + "put"));
}

class ForeignRecord : public testing::TestWithParam<const char*> {};

TEST_P(ForeignRecord, IsNone) {
  const std::string text =
      "flowdlo commit 1\nkey camera.json\n" + std::string(GetParam()) + "\nend\n";
  EXPECT_FALSE(parse_record(text));
}

INSTANTIATE_TEST_SUITE_P(CommitRecord, ForeignRecord,
                         testing::Values("put .flowdlo-0123456789abcdef.part ../depth.png",
                                         "put .flowdlo-0123456789abcdef.part a/b",
                                         "put ../../passwd depth.png", "put depth.png depth.png",
                                         "put .flowdlo-0123456789abcdef.part",
                                         "put .flowdlo-0123456789abcdef.part ",
                                         "put .flowdlo-0123456789ABCDEF.part a", "remove ..",
                                         "remove ", "remove a/b", "key a", "fetch a", ""));

TEST(CommitRecord, WithoutAKeyIsNone) { EXPECT_FALSE(parse_record("flowdlo commit 1\nend\n")); }

}  // namespace
}  // namespace flowdlo::files
