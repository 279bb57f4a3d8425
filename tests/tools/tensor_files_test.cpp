#include "tensor_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

namespace flowdlo::tools {
namespace {

using testing::HasSubstr;

Tensors whole() {
  Tensors tensors;
  tensors.draws = 2;
  tensors.field_width = 8;
  tensors.field_height = 6;
  tensors.source.resize(2 * 64 * 3);
  tensors.visible.resize(256 * 3);
  tensors.visible_valid.resize(256);
  tensors.path.resize(20 * 2);
  tensors.prior.resize(64 * 3);
  tensors.support.resize(64);
  tensors.draw_prior.resize(2 * 64 * 3);
  tensors.draw_support.resize(2 * 64);
  tensors.prediction.resize(2 * 64 * 3);
  tensors.mask_field.resize(4 * 6 * 8);
  return tensors;
}

TEST(TensorFiles, HaveTheNamesAndShapesOfTheContract) {
  const auto files = tensor_files(whole());
  ASSERT_TRUE(files) << files.error().message;
  const std::map<std::string, std::string> bytes(files->begin(), files->end());
  const std::map<std::string, std::string> shapes = {
      {"source.npy", "(2, 64, 3)"},     {"visible.npy", "(256, 3)"},
      {"visible_valid.npy", "(256,)"},  {"path.npy", "(20, 2)"},
      {"prior.npy", "(64, 3)"},         {"support.npy", "(64,)"},
      {"draw_prior.npy", "(2, 64, 3)"}, {"draw_support.npy", "(2, 64)"},
      {"prediction.npy", "(2, 64, 3)"}, {"mask_field.npy", "(4, 6, 8)"}};
  ASSERT_EQ(bytes.size(), shapes.size());
  for (const auto& [name, shape] : shapes) {
    ASSERT_EQ(bytes.count(name), 1U) << name;
    EXPECT_THAT(bytes.at(name), HasSubstr("'shape': " + shape)) << name;
  }
}

TEST(TensorFiles, TheStrandFieldIsWrittenWhereThereIsOne) {
  auto tensors = whole();
  tensors.strands = {
      .width = 4, .height = 3, .first_u = 7, .first_v = 5, .scale_u = 2, .scale_v = 2};
  tensors.strands.channels.resize(10 * 3 * 4);
  const auto files = tensor_files(tensors);
  ASSERT_TRUE(files) << files.error().message;
  const std::map<std::string, std::string> bytes(files->begin(), files->end());
  EXPECT_EQ(bytes.size(), kTensorFileNames.size());
  EXPECT_THAT(bytes.at("field.npy"), HasSubstr("'shape': (10, 3, 4)"));
  const auto region = nlohmann::json::parse(bytes.at("field_region.json"));
  EXPECT_EQ(region.at("channels").size(), 10U);
  EXPECT_EQ(region.at("channels").at(3), "tip");
  EXPECT_EQ(region.at("origin"), nlohmann::json({6.75, 4.75}));  // of a pixel half as large
  EXPECT_EQ(region.at("scale"), nlohmann::json({0.5, 0.5}));
  for (const auto& [name, content] : bytes) {
    EXPECT_THAT(kTensorFileNames, testing::Contains(testing::StrEq(name)));
  }
}

TEST(TensorFiles, AreAllAmongTheNamesThatACleanupKnows) {
  const auto files = tensor_files(whole());
  ASSERT_TRUE(files);
  for (const auto& file : *files) {
    EXPECT_THAT(kTensorFileNames, testing::Contains(testing::StrEq(file.first)));
  }
}

TEST(TensorFiles, TensorsOfAnotherShapeThanStatedAreListed) {
  auto tensors = whole();
  tensors.source.pop_back();
  tensors.mask_field.clear();
  const auto files = tensor_files(tensors);
  ASSERT_FALSE(files);
  EXPECT_THAT(files.error().message,
              HasSubstr("source.npy: expected 384 values (2 x 64 x 3), got 383"));
  EXPECT_THAT(files.error().message, HasSubstr("mask_field.npy"));
}

}  // namespace
}  // namespace flowdlo::tools
