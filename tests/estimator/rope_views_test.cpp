#include "estimator/rope_views.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "estimator/parted.hpp"
#include "estimator/see_axes.hpp"
#include "field/network.hpp"
#include "reference/program.hpp"
#include "scene/ropes.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo {
namespace {

using lab::make_ropes;
using lab::RopesKind;

TEST(RopeViews, AnUpperRopesPixelsAreThereInTheLowerOnesViewWithoutDepth) {
  const auto scene = make_ropes(RopesKind::kHanging, 2, 0);
  const auto parted = estimator::part_ropes(scene.frame(), 2);
  ASSERT_TRUE(parted) << parted.error().message;
  std::size_t shared = 0;
  for (std::size_t rope = 0; rope < 2; ++rope) {
    const estimator::RopeView view(*parted, rope, scene.frame());
    const Frame frame = view.frame();
    for (std::size_t p = 0; p < frame.mask.size(); ++p) {
      const bool own = parted->instances[p] == rope + 1;
      if (own) {
        ASSERT_GT(frame.mask[p], 127);
        ASSERT_EQ(frame.depth_m[p], scene.image.depth_m[p]);
      } else if (frame.mask[p] > 127) {
        ++shared;
        ASSERT_EQ(frame.depth_m[p], 0);
      }
    }
  }
  EXPECT_GT(shared, 10U);
}

TEST(RopeViews, TakeAlongWhatTheFieldShows) {
  auto weights = weights::load_field(FLOWDLO_FIELD_WEIGHTS);
  ASSERT_TRUE(weights) << weights.error().message;
  auto network =
      field::Network::create(std::make_shared<const weights::FieldWeights>(*std::move(weights)),
                             [] { return reference::create_program(1); });
  ASSERT_TRUE(network);
  const auto scene = make_ropes(RopesKind::kCrossing, 2, 0);
  const Frame frame = scene.frame();
  const auto parted = estimator::part_ropes(frame, 0, estimator::seen_by(&*network));
  ASSERT_TRUE(parted) << parted.error().message;
  ASSERT_EQ(parted->paths.ropes.size(), 2U);
  for (std::size_t rope = 0; rope < 2; ++rope) {
    const auto traced = estimator::RopeView(*parted, rope, frame).traced();
    ASSERT_TRUE(traced.seen);
    const auto& points = traced.paths.ranked.front().points_px;
    const std::size_t place = points.size() / 10;
    const Eigen::Vector2f along = (points[place + 2] - points[place]).normalized();
    EXPECT_GT(traced.seen->shown(points[place + 1], along).any(), 0.4F);
  }
  const auto masked = estimator::part_ropes(frame, 0);
  ASSERT_TRUE(masked);
  EXPECT_FALSE(estimator::RopeView(*masked, 0, frame).traced().seen) << "none was asked";
}

}  // namespace
}  // namespace flowdlo
