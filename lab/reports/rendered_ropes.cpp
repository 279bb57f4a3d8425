#include "reports/rendered_ropes.hpp"

#include <algorithm>
#include <utility>

#include "scene/setting.hpp"
#include "strand/patch.hpp"

namespace flowdlo::lab {
namespace {

constexpr double kLeastWidths = 6;  // of a rope in the image

bool inside(const strand::AxisPoint& p, const FrameFolder& image) {
  return p.u >= 0 && p.v >= 0 && p.u <= static_cast<float>(image.width - 1) &&
         p.v <= static_cast<float>(image.height - 1);
}

// Empty where the image shows less than one stretch of it, or more.
std::optional<SeenRope> seen_rope(const strand::Strand& strand, const synth::TrueRope& rope,
                                  const FrameFolder& image) {
  const auto& points = strand.points;
  const auto in = [&](const strand::AxisPoint& p) { return inside(p, image); };
  const auto first_in = std::find_if(points.begin(), points.end(), in);
  const auto end_in = std::find_if_not(first_in, points.end(), in);
  const bool once = std::none_of(end_in, points.end(), in);
  const bool whole = first_in == points.begin() && end_in == points.end();
  if (!once || (rope.closed && !whole)) return std::nullopt;
  const auto shows = [](const strand::AxisPoint& p) { return p.seen != strand::Seen::kNo; };
  const auto first = rope.closed ? first_in : std::find_if(first_in, end_in, shows);
  auto end = end_in;
  while (!rope.closed && end != first && !shows(*(end - 1))) --end;
  if (end - first < 2 || (end - 1)->along_widths - first->along_widths < kLeastWidths) {
    return std::nullopt;
  }
  SeenRope seen;
  seen.radius_m = rope.radius_m;
  seen.closed = rope.closed;
  const auto axis = [&](auto from, auto to) {
    Curve3 curve;
    for (auto p = from; p != to; ++p) {
      const auto z = static_cast<double>(p->depth_m);
      curve.emplace_back(
          (static_cast<double>(p->u) - image.intrinsics.cx) * z / image.intrinsics.fx,
          (static_cast<double>(p->v) - image.intrinsics.cy) * z / image.intrinsics.fy, z);
    }
    return curve;
  };
  seen.curve = axis(first, end);
  if (!rope.closed) seen.unseen = {axis(points.begin(), first), axis(end, points.end())};
  if (rope.closed) seen.curve.back() = seen.curve.front();
  seen.truth = nodes_of(seen.curve);
  return seen;
}

}  // namespace

Result<std::optional<RenderedRopes>> rendered_ropes(synth::Split split, synth::Part part,
                                                    std::uint64_t index, bool cords) {
  synth::Render render;
  render.cords = cords;
  render.dense = true;
  auto frame = synth::make_frame(split, part, 0, index, render);
  if (!frame) return frame.error();
  RenderedRopes result;
  result.scenario = frame->meta.scenario;
  const auto strands = strand::whole_strands_of(*frame);
  for (std::size_t k = 0; k < strands.size(); ++k) {
    auto seen = seen_rope(strands[k], frame->ropes[k], frame->folder);
    if (!seen) return std::optional<RenderedRopes>();
    result.scene.ropes.push_back(*std::move(seen));
  }
  FrameFolder& folder = frame->folder;
  result.scene.image = {folder.width,
                        folder.height,
                        folder.intrinsics,
                        std::move(folder.depth_m),
                        std::move(folder.mask),
                        std::move(folder.color_bgr),
                        std::move(folder.instances)};
  return std::optional(std::move(result));
}

}  // namespace flowdlo::lab
