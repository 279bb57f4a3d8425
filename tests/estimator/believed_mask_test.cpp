#include "estimator/believed_mask.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "flowdlo/estimator.hpp"
#include "geometry/polyline.hpp"
#include "image/brush.hpp"
#include "scene/scene.hpp"
#include "support/painted_field.hpp"

namespace flowdlo {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::IsEmpty;

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr float kRope_px = 8;

/// A frame's mask beside a field that shows a rope of kRope_px from left to right along v = 60, and
/// another one along v = 90.
class BelievedMask : public ::testing::Test {
 protected:
  BelievedMask() {
    field::StrandField seen;
    seen.region = {{0, 0, kWidth, kHeight}, {kWidth, kHeight}, {1, 1}};
    seen.channels = testing::painted_field(
        {testing::straight_axis({20, 60}, {140, 60}), testing::straight_axis({20, 90}, {140, 90})},
        {kWidth, kHeight});
    axes_.width_px = kRope_px;
    axes_.view = field::FieldView(seen);
  }

  /// A stroke of so many pixels along v = 60 and as many below it, from left to right.
  void mask(int above, int below) {
    std::fill(mask_.begin(), mask_.end(), std::uint8_t{0});
    for (int v = 60 - above; v <= 60 + below; ++v) {
      for (int u = 17; u <= 143; ++u) mask_[index(u, v)] = 255;
    }
  }
  [[nodiscard]] Bytes believed(float rope_width_px) const {
    Frame frame;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.mask = mask_;
    frame.instances = labels_;
    return estimator::believed_mask(frame, rope_width_px, axes_);
  }
  static std::size_t index(int u, int v) {
    return static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
  }
  static std::vector<int> from_to(int first, int last) {
    std::vector<int> all(static_cast<std::size_t>(last - first + 1));
    std::iota(all.begin(), all.end(), first);
    return all;
  }
  /// Rows of a believed mask that are set at u = 80; none of one that is the frame's.
  static std::vector<int> rows(const Bytes& mask) {
    std::vector<int> set;
    if (mask.empty()) return set;
    EXPECT_EQ(mask.size(), static_cast<std::size_t>(kWidth) * kHeight);
    for (int v = 0; v < kHeight; ++v) {
      if (mask[index(80, v)] > 127) set.push_back(v);
    }
    return set;
  }

  Bytes mask_ = Bytes(static_cast<std::size_t>(kWidth) * kHeight, 0);
  std::vector<std::uint16_t> labels_;
  field::Axes axes_;
};

TEST_F(BelievedMask, IsTheFramesWhereTheFieldShowsTheSame) {
  mask(4, 4);
  EXPECT_THAT(believed(9), IsEmpty());
  mask(5, 4);
  EXPECT_THAT(believed(10), IsEmpty()) << "a pixel more or less does not matter";
}

TEST_F(BelievedMask, IsCutToWhatTheFieldShows) {
  mask(9, 9);
  EXPECT_EQ(rows(believed(19)), from_to(56, 64)) << "nothing of the other rope";
}

TEST_F(BelievedMask, GrowsToWhatTheFieldShowsBesideANarrowOne) {
  mask(1, 1);
  EXPECT_EQ(rows(believed(3)), from_to(56, 64)) << "nothing of the other rope";
}

TEST_F(BelievedMask, ThatLiesAsideIsCutAndThenGrows) {
  mask(0, 8);
  const Bytes cut = believed(9);
  ASSERT_EQ(rows(cut), from_to(60, 64));
  mask_ = cut;
  EXPECT_EQ(rows(believed(5)), from_to(56, 64));
}

TEST_F(BelievedMask, OfARopesOwnWidthTakesNothingFromARopeBesideIt) {
  mask(4, 4);
  field::StrandField seen;  // of two ropes that touch; the mask is one of them
  seen.region = {{0, 0, kWidth, kHeight}, {kWidth, kHeight}, {1, 1}};
  seen.channels = testing::painted_field(
      {testing::straight_axis({20, 60}, {140, 60}), testing::straight_axis({20, 68}, {140, 68})},
      {kWidth, kHeight});
  axes_.view = field::FieldView(seen);
  EXPECT_THAT(believed(9), IsEmpty());
}

TEST_F(BelievedMask, GetsNothingWhereLabelsSayWhatIsBesideIt) {
  mask(1, 1);
  labels_.assign(mask_.size(), 0);
  EXPECT_THAT(believed(3), IsEmpty());
  mask(9, 9);
  EXPECT_EQ(rows(believed(19)), from_to(56, 64)) << "but it is cut";
}

TEST_F(BelievedMask, IsTheFramesWhereTheFieldShowsNoRope) {
  mask(9, 9);
  axes_.view = {};
  EXPECT_THAT(believed(19), IsEmpty());
}

Estimator make() {
  return *Estimator::create({.weights = FLOWDLO_DEFAULT_WEIGHTS,
                             .device = "cpu",
                             .quality = Quality::kFast,
                             .threads = 1});
}

/// `mask` with so many pixels more on each side; fewer where there are less than 0.
Bytes wider(const Bytes& mask, const lab::Image& image, int by_px) {
  image::Mask given({image.width, image.height});
  for (int v = 0; v < image.height; ++v) {
    std::copy_n(mask.data() + static_cast<std::size_t>(v) * image.width, image.width, given.row(v));
  }
  const image::Mask changed =
      by_px > 0 ? image::dilated(given, by_px) : image::eroded(given, -by_px);
  Bytes result;
  for (int v = 0; v < image.height; ++v) {
    result.insert(result.end(), changed.row(v), changed.row(v) + image.width);
  }
  return result;
}

/// Ropes of drawn scenes, under masks that are so many pixels too wide on each side.
class MaskTooWide : public ::testing::TestWithParam<int> {};

TEST_P(MaskTooWide, IsReadAsTheRopeThatShowsInIt) {
  auto estimator = make();
  for (const auto kind : {lab::Kind::kHanging, lab::Kind::kOneCrossing}) {
    const auto scene = lab::make_scene(kind, 11);
    Frame frame = scene.frame();
    const Bytes mask = wider(scene.image.mask, scene.image, GetParam());
    frame.mask = mask;
    const auto estimate = estimator.estimate(frame);
    ASSERT_TRUE(estimate) << estimate.error().message;
    EXPECT_LT(geometry::mean_distance(estimate->nodes, scene.truth), 0.002) << name_of(kind);
    EXPECT_GT(estimate->confidence, 0.9F) << name_of(kind);
  }
}

INSTANTIATE_TEST_SUITE_P(By, MaskTooWide, ::testing::Values(-1, 1, 2, 4), [](const auto& by) {
  return by.param < 0 ? "OnePixelLess" : "Pixels" + std::to_string(by.param);
});

}  // namespace
}  // namespace flowdlo
