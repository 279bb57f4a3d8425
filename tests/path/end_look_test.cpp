#include "path/end_look.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "field/channel.hpp"
#include "path/links.hpp"
#include "path/strand_reading.hpp"
#include "seen.hpp"

namespace flowdlo::path {
namespace {

using testing::straight_axis;

EndLook colored(float blue, float green, float red, float spread) {
  EndLook look;
  look.color_bgr = {blue, green, red};
  look.color_spread = spread;
  return look;
}

TEST(EndLook, AnotherColourIsAMisfitAndNoLightMakesOne) {
  const EndLook red = colored(30, 30, 200, 8);
  EXPECT_EQ(color_misfit(red, red), 0);
  EXPECT_LT(color_misfit(red, colored(28, 27, 190, 8)), 0.1F);
  EXPECT_LT(color_misfit(red, colored(8, 8, 50, 8)), 0.1F) << "in the shade";
  EXPECT_LT(color_misfit(colored(90, 90, 90, 4), colored(240, 240, 240, 4)), 0.1F);
  EXPECT_EQ(color_misfit(colored(0, 0, 0, 0), colored(0, 0, 0, 0)), 0) << "nothing to be seen";
  EXPECT_GT(color_misfit(red, colored(200, 60, 30, 8)), 0.95F);
  EXPECT_EQ(color_misfit(red, colored(200, 60, 30, 8)), color_misfit(colored(200, 60, 30, 8), red));
  EXPECT_GT(color_misfit(red, colored(60, 60, 160, 4)), color_misfit(red, colored(60, 60, 160, 40)))
      << "what varies along a rope tells less";
}

TEST(EndLook, WithoutColourNothingIsHeldAgainstAnyone) {
  EXPECT_EQ(color_misfit(colored(30, 30, 200, 8), EndLook{}), 0);
  EXPECT_EQ(color_misfit(EndLook{}, EndLook{}), 0);
}

/// Two level ropes with a gap between them.
struct TwoAxes : test::Seen {
  TwoAxes() : Seen({straight_axis({40, 120}, {140, 120}), straight_axis({180, 120}, {280, 120})}) {}

  LinkTerms link() const {
    Frame frame = canvas.frame();
    frame.color_bgr = color;
    const auto region = clean(frame);
    EXPECT_TRUE(region);
    field::Axes axes;
    axes.width_px = 8;
    axes.view = field::FieldView(this->field);
    axes.lines.push_back({straight_axis({40, 120}, {140, 120}), {1, 0}});
    axes.lines.push_back({straight_axis({180, 120}, {280, 120}), {0, 1}});
    const Strands strands = strands_of(frame, axes, *region);
    const Cover cover(*region, frame, strands.width_px, strands.seen);
    return link_between(1, 2, strands, cover, kOneRopeLinks).terms;
  }
  using Bgr = std::array<std::uint8_t, 3>;

  void paint(const Bgr& left, const Bgr& right) {
    const int width = canvas.mask.cols;
    color.clear();
    for (std::size_t i = 0; i < canvas.mask.total(); ++i) {
      const Bgr& here = static_cast<int>(i) % width < 160 ? left : right;
      color.insert(color.end(), here.begin(), here.end());
    }
  }

  std::vector<std::uint8_t> color;
};

TEST(EndLook, ALinkBetweenStrandsOfOtherColoursPaysForIt) {
  TwoAxes pair;
  EXPECT_EQ(pair.link()[kLinkColor], 0) << "no colour";
  pair.paint({90, 30, 30}, {90, 30, 30});
  EXPECT_EQ(pair.link()[kLinkColor], 0);
  pair.paint({90, 30, 30}, {30, 90, 200});
  EXPECT_GT(pair.link()[kLinkColor], 0.9F);
}

}  // namespace
}  // namespace flowdlo::path
