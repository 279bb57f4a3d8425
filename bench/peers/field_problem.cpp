#include "peers/field_problem.hpp"

#include <algorithm>

#include "flowdlo/frame_folder.hpp"
#include "geometry/mask_box.hpp"
#include "path/path.hpp"

namespace flowdlo::peers {
namespace {

int whole_blocks(int px) {
  return (px + field::kBlock_px - 1) / field::kBlock_px * field::kBlock_px;
}

/// `from`, whose (0, 0) comes to lie at (left, top), in an image of that size.
field::Planes moved(const field::Planes& from, int left, int top, const image::Size& size) {
  field::Planes to(size, {});
  for (int v = std::max(0, top); v < std::min(size.height, top + from.height()); ++v) {
    for (int u = std::max(0, left); u < std::min(size.width, left + from.width()); ++u) {
      to.at(v, u) = from.at(v - top, u - left);
    }
  }
  return to;
}

std::vector<float> planes_of(const field::Planes& input) {
  std::vector<float> planes;
  for (int plane = 0; plane < field::kPlanes; ++plane) {
    for (std::size_t i = 0; i < input.total(); ++i) {
      planes.push_back(input.data()[i][static_cast<std::size_t>(plane)]);
    }
  }
  return planes;
}

}  // namespace

Result<FieldProblem> region_problem(std::shared_ptr<const weights::FieldWeights> of,
                                    const std::filesystem::path& frame, int threads) {
  const auto folder = load_frame_folder(frame);
  if (!folder) return folder.error();
  const Frame view = folder->frame();
  const auto traced = path::trace(view);
  if (!traced) return traced.error();
  const auto region = field::region_around(geometry::mask_box(view), {view.width, view.height},
                                           traced->rope_width_px);
  const auto sight = field::look(view, region);
  FieldProblem problem;
  problem.weights = std::move(of);
  problem.threads = threads;
  problem.input = moved(field::input_of(sight), 0, 0,
                        {whole_blocks(region.size.width), whole_blocks(region.size.height)});
  problem.blocks = field::blocks_near(sight.mask);
  problem.planes = planes_of(problem.input);
  return problem;
}

FieldProblem dense_problem(const FieldProblem& region, int side) {
  FieldProblem problem;
  problem.weights = region.weights;
  problem.threads = region.threads;
  problem.input =
      moved(region.input, (side - region.width()) / 2, (side - region.height()) / 2, {side, side});
  problem.blocks = field::blocks_near(image::Image<float>(problem.input.size(), 1.0F));
  problem.planes = planes_of(problem.input);
  return problem;
}

}  // namespace flowdlo::peers
