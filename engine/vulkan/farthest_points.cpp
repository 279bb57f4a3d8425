#include <fmt/format.h>

#include <algorithm>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kShare = 2048;  // points a workgroup
constexpr int kPicks = ops::kVisibleRows;
constexpr int kMostLoopTurns = 65535;   // a lavapipe shader stops there, without a word
constexpr int kLargestIndex = 1 << 24;  // point_count is a float

/// Turns of all loops of one lane, at worst.
int loop_turns(int capacity, int lanes) {
  const int groups = (capacity + kShare - 1) / kShare;
  constexpr int kReductions = 2 * 8;  // over_lanes, twice, log2(128) turns at most
  return kShare / lanes + (groups + lanes - 1) / lanes + kReductions;
}

bool sound(Plan& plan, const ops::FarthestPoints& op) {
  if (op.cloud.columns != 4 || op.visible.columns != 4 || op.visible.rows != kPicks ||
      op.params.columns != 16 || op.cloud.rows < 1 || op.cloud.rows > kLargestIndex) {
    plan.fault(
        fmt::format("FarthestPoints: expected cloud [1..{}, 4], params [1, 16], visible "
                    "[256, 4], got [{}, {}], [{}, {}], [{}, {}]",
                    kLargestIndex, op.cloud.rows, op.cloud.columns, op.params.rows,
                    op.params.columns, op.visible.rows, op.visible.columns));
    return false;
  }
  if (loop_turns(op.cloud.rows, plan.lanes()) > kMostLoopTurns) {
    plan.fault(
        fmt::format("FarthestPoints: expected a cloud that takes at most {} loop turns a "
                    "lane, got {} points",
                    kMostLoopTurns, op.cloud.rows));
    return false;
  }
  return true;
}

}  // namespace

void record_farthest_points(Plan& plan, const ops::FarthestPoints& op) {
  if (!sound(plan, op)) return;
  const int capacity = op.cloud.rows;
  const int most_groups = (capacity + kShare - 1) / kShare;
  const auto scratch = [&](std::string_view name, int rows, int columns) {
    return plan.whole(plan.tensor(Home::kDevice, name, rows, columns));
  };
  const Range groups = scratch("farthest_points groups", 1, 4);
  const Range nearest = scratch("farthest_points nearest", capacity, 1);
  const std::array<Range, 2> farthest{scratch("farthest_points even", most_groups, 4),
                                      scratch("farthest_points odd", most_groups, 4)};
  const Range cloud = plan.whole(op.cloud);
  const Range params = plan.whole(op.params);
  const Range visible = plan.whole(op.visible);

  plan.dispatch(FarthestSetupCall{{cloud}, {params}, {visible}, {groups}},
                {.lanes = plan.lanes(), .share = kShare}, {.capacity = capacity, .row = 0},
                {static_cast<std::uint32_t>(kPicks / plan.lanes())});

  // Pass 0 finds the point farthest from the centroid; pass p writes pick p - 1, then goes on.
  const bool texels = plan.fits(cloud, 16) && plan.fits(nearest, 4);
  for (int pass = 0; pass <= kPicks; ++pass) {
    const FarthestPointsCall call{.cloud_texels = {plan.cut(cloud, 16)},
                                  .cloud = {cloud},
                                  .params = {params},
                                  .previous = {farthest[(pass + 1) % 2]},
                                  .nearest_texels = {plan.cut(nearest, 4)},
                                  .nearest = {nearest},
                                  .farthest = {farthest[pass % 2]},
                                  .visible = {visible}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .share = kShare,
                   .first_pass = pass == 0 ? 1 : 0,
                   .cloud_is_texels = texels ? 1 : 0},
                  {.capacity = capacity, .row = std::max(pass - 1, 0)}, {},
                  Range{groups.resource, 0, 12});
  }
}

}  // namespace flowdlo::vulkan
