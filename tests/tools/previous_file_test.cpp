#include "previous_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "estimate_json.hpp"
#include "frame/temporary_folder.hpp"
#include "tools/sample_estimate.hpp"

namespace flowdlo::tools {
namespace {

using testing::HasSubstr;

class PreviousFile : public testing::Test {
 protected:
  [[nodiscard]] Result<Centerline> read(const std::string& text) const {
    test::write_text(file(), text);
    return read_previous(file());
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "before.json"; }

  test::TemporaryFolder folder_;
};

TEST_F(PreviousFile, GivesTheNodesThatWereWritten) {
  const auto estimate = test::sample_estimate();
  const auto nodes = read(estimate_json(estimate, {}));
  ASSERT_TRUE(nodes) << nodes.error().message;
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_NEAR((*nodes)[i].x, estimate.nodes[i].x, 1e-7);
    EXPECT_EQ((*nodes)[i].z, 0.5F);
  }
}

TEST_F(PreviousFile, OfAFrameWithoutAnEstimateSaysSo) {
  const auto nodes = read(failure_json({ErrorCode::kNoPath, "no stroke"}, {}));
  ASSERT_FALSE(nodes);
  EXPECT_EQ(nodes.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(nodes.error().message, HasSubstr("before.json: nodes_m: expected 64 points, got the "
                                               "failure \"no_path\""));
}

TEST_F(PreviousFile, ThatIsNotThereIsNamed) {
  const auto nodes = read_previous(file());
  ASSERT_FALSE(nodes);
  EXPECT_EQ(nodes.error().code, ErrorCode::kIo);
  EXPECT_THAT(nodes.error().message, HasSubstr("before.json"));
}

std::string with_nodes(const std::string& node, int count) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i == 0 ? "" : ",") + node;
  return fmt::format(R"({{"status": "ok", "nodes_m": [{}]}})", list);
}

TEST_F(PreviousFile, RefusesWhatIsNoEstimate) {
  for (const std::string& text :
       {std::string(), std::string("{\"nodes_m\": "), std::string("[]"), std::string("{}"),
        std::string(R"({"nodes_m": 64})"), std::string(R"({"status": "ok", "nodes_m": []})"),
        std::string(200000, '['), with_nodes("[0, 0, 1]", 63), with_nodes("[0, 0, 1]", 65),
        with_nodes("[0, 1]", 64), with_nodes("[0, 0, null]", 64), with_nodes("[0, 0, 1e39]", 64),
        with_nodes("[0, 0, \"1\"]", 64), with_nodes("1", 64)}) {
    const auto nodes = read(text);
    ASSERT_FALSE(nodes) << text.substr(0, 80);
    EXPECT_EQ(nodes.error().code, ErrorCode::kBadInput) << text.substr(0, 80);
    EXPECT_THAT(nodes.error().message, HasSubstr("name an estimate.json"));
  }
  EXPECT_TRUE(read(with_nodes("[0, 0, 1]", 64))) << "otherwise all of it would be refused";
}

}  // namespace
}  // namespace flowdlo::tools
