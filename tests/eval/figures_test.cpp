#include "eval/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "eval/scenes.hpp"
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
  EXPECT_THAT(names_of(*drawn), ElementsAre("set_paired_bars", "set_steps", "set_reliability"));
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

}  // namespace
}  // namespace flowdlo::eval
