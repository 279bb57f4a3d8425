// What is served of which address.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/sample_estimate.hpp"
#include "tools/view/rope_before_wall.hpp"
#include "view/pages.hpp"

namespace flowdlo::view {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ShownFrame, HasTheCurveThePointsAndThePictures) {
  const test::RopeBeforeWall owned;
  Seen seen;
  seen.ropes.ropes = {test::sample_estimate()};
  seen.device = "cpu";
  const auto shown = shown_frame("rope", owned.frame(), seen);
  ASSERT_TRUE(shown) << shown.error().message;
  const json scene = json::parse(shown->scene);
  ASSERT_EQ(scene["ropes"].size(), 1U);
  const json& rope = scene["ropes"][0];
  EXPECT_EQ(rope["nodes"].size(), 64U);
  EXPECT_EQ(rope["curve"].size(), 253U);
  EXPECT_EQ(rope["alternatives"].size(), 1U);
  EXPECT_EQ(rope["origin"], "first_prior");
  EXPECT_NEAR(rope["nodes"][0][0], -0.15, 1e-5);
  EXPECT_EQ(scene["measured"].size(), 58U);
  EXPECT_EQ(scene["scenery"].size(),
            owned.kWidth * owned.kHeight - 58U - 1);  // one pixel has no depth
  EXPECT_EQ(scene["measured"][0][3], "5a5a5a");
  EXPECT_NEAR(scene["measured"][0][0], (10 - 39.5) * 0.5 / 100, 1e-6);
  for (const auto* png : {&shown->image, &shown->mask}) EXPECT_EQ(png->substr(1, 3), "PNG");
  EXPECT_EQ(shown->field, "");
  EXPECT_FALSE(scene["field"]);
}

TEST(ShownFrame, WithoutAnEstimateSaysWhy) {
  const test::RopeBeforeWall owned;
  const auto shown = shown_frame("rope", owned.frame(), Error{ErrorCode::kNoPath, "no \"way\""});
  ASSERT_TRUE(shown);
  const json scene = json::parse(shown->scene);
  EXPECT_EQ(scene["error"], "no \"way\"");
  EXPECT_EQ(scene["ropes"].size(), 0U);
  EXPECT_NE(shown->image, "");
  const auto failure = shown_failure("a\xff<script>", Error{ErrorCode::kIo, "gone"});
  EXPECT_TRUE(json::accept(failure.scene));
  EXPECT_EQ(failure.image, "");
}

TEST(ShownFrame, OfALargeFrameStaysBounded) {
  const test::RopeBeforeWall owned;
  Frame frame = owned.frame();
  frame.width = 1600;
  frame.height = 1200;
  const std::vector<float> depth_m(1600 * 1200, 1.0F);
  const std::vector<std::uint8_t> mask(1600 * 1200, 0);
  frame.depth_m = depth_m;
  frame.mask = mask;
  frame.color_bgr = {};
  const auto shown = shown_frame("wall", frame, Error{ErrorCode::kNoEvidence, "no rope"});
  ASSERT_TRUE(shown);
  const auto scenery = json::parse(shown->scene)["scenery"].size();
  EXPECT_GT(scenery, 4000U);
  EXPECT_LE(scenery, 7000U);
}

HttpRequest asking(const std::string& target) { return {"GET", target, ""}; }

class Served : public ::testing::Test {
 protected:
  Pages pages_{"key", {"one", "two\xff"}, [this](std::size_t frame) {
                 asked_.push_back(frame);
                 return ShownFrame{"{}", "image", "mask", ""};
               }};
  std::vector<std::size_t> asked_;
};

TEST_F(Served, HasThePageItsScriptAndTheListOfFrames) {
  const auto page = pages_.response(asking("/key/"));
  EXPECT_EQ(page.type, "text/html; charset=utf-8");
  EXPECT_THAT(page.body, HasSubstr("<script src=\"view.js\"></script>"));
  EXPECT_THAT(pages_.response(asking("/key/view.js")).body, HasSubstr("drawSpace"));
  const auto list = pages_.response(asking("/key/frames.json"));
  EXPECT_EQ(json::parse(list.body).at(0), "one");
  EXPECT_EQ(json::parse(list.body).size(), 2U);
  EXPECT_THAT(asked_, ElementsAre());
}

TEST_F(Served, NeedsNothingFromElsewhere) {
  for (const auto& text : {page_text(), script_text()}) {
    for (const char* reference : {"http:", "https:", "//cdn", "@import", "eval(", "innerHTML"}) {
      EXPECT_THAT(text, Not(HasSubstr(reference)));
    }
  }
}

TEST_F(Served, AsksOnceForAFrameThatIsKept) {
  EXPECT_EQ(pages_.response(asking("/key/frames/1/scene.json")).body, "{}");
  EXPECT_EQ(pages_.response(asking("/key/frames/1/image.png")).type, "image/png");
  EXPECT_EQ(pages_.response(asking("/key/frames/1/mask.png")).body, "mask");
  EXPECT_EQ(pages_.response(asking("/key/frames/0/scene.json")).status, 200);
  EXPECT_EQ(pages_.response(asking("/key/frames/1/scene.json")).status, 200);
  EXPECT_THAT(asked_, ElementsAre(1, 0));
}

TEST_F(Served, IsNothingElse) {
  for (const char* target :
       {"/", "/key", "/kez/", "/key/view", "/key/frames/2/scene.json", "/key/frames/-1/scene.json",
        "/key/frames/1", "/key/frames/1/", "/key/frames//scene.json", "/key/frames/1/../0/mask.png",
        "/key/frames/99999999999999999999/scene.json", "/key/frames/0x1/scene.json",
        "/key/frames/1/field.png", "/key/../etc/passwd", "/key/%2e%2e/", "/key//", "/key/?",
        "/frames.json"}) {
    EXPECT_EQ(pages_.response(asking(target)).status, 404) << target;
  }
}

TEST(Secret, IsLongAndNeverTheSame) {
  EXPECT_EQ(secret().size(), 32U);
  EXPECT_NE(secret(), secret());
}

}  // namespace
}  // namespace flowdlo::view
