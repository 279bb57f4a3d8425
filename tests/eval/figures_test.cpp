#include "eval/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "eval/example_sheet.hpp"
#include "eval/scenes.hpp"
#include "eval/space_view.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::eval {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> names_of(const std::vector<Figure>& figures) {
  std::vector<std::string> names;
  for (const Figure& figure : figures) names.push_back(figure.name);
  return names;
}

TEST(Figures, EveryFigureOfTheChapterIsDrawn) {
  const std::vector<Trial> trials{test::scene("a", "intersection-complicated"),
                                  test::scene_without_baseline("b", "S-complicated")};
  const auto drawn = figures(trials);
  ASSERT_TRUE(drawn) << drawn.error().message;
  EXPECT_THAT(names_of(*drawn), ElementsAre("set_paired_bars", "set_examples", "set_steps",
                                            "set_time_sweep", "set_reliability"));
  for (const Figure& figure : *drawn) {
    EXPECT_GT(cv::imdecode(figure.png, cv::IMREAD_COLOR).cols, 400) << figure.name;
  }
}

TEST(Figures, FramesWithoutTruthAreOverlaid) {
  const flowdlo::test::TemporaryFolder folder;
  std::vector<Trial> trials{test::real_frame("a"), test::real_frame("gone")};
  trials[0].folder = flowdlo::test::write_frame(folder.path());
  trials[1].folder = folder.path() / "gone";
  const auto drawn = figures(trials);
  ASSERT_TRUE(drawn) << drawn.error().message;
  EXPECT_THAT(names_of(*drawn), ElementsAre("set_overlays"));
}

TEST(Figures, OfNothingAreNone) {
  const auto drawn = figures(std::vector<Trial>());
  ASSERT_TRUE(drawn);
  EXPECT_THAT(*drawn, IsEmpty());
}

TEST(FixedExamples, DoNotDependOnErrors) {
  std::vector<Trial> trials;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    trials.push_back(test::scene(name, "intersection"));
  }
  const auto before = fixed_examples(data_sets_of(trials)[0]);
  for (Trial& trial : trials) trial.methods["estimate"].index_m = trial.name == "a" ? 0 : 1;
  const auto after = fixed_examples(data_sets_of(trials)[0]);
  EXPECT_EQ(before, after);
  EXPECT_EQ(before.size(), 2U);
}

TEST(SpaceView, SubjectFillsThePanelAndStaysInIt) {
  const Centerline nodes = test::wave(0.2);
  const SpaceView view(nodes, {300, 200});
  int left = 300;
  int right = 0;
  for (const Point3& node : nodes) {
    const cv::Point at = view.at(node);
    EXPECT_TRUE(cv::Rect(0, 0, 300, 200).contains(at));
    left = std::min(left, at.x);
    right = std::max(right, at.x);
  }
  EXPECT_NEAR(right - left, 240, 3);
}

TEST(SpaceView, FarPointsStayPixels) {
  const SpaceView view(test::wave(0), {300, 200});
  EXPECT_LE(std::abs(view.at({1e30F, -1e30F, 5}).x), 40000);
}

}  // namespace
}  // namespace flowdlo::eval
