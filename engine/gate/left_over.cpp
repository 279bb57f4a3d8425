#include "gate/left_over.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "geometry/mask_box.hpp"

namespace flowdlo::gate {
namespace {

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kCellsAcross = 6;             // a rope's width
constexpr float kNear = 1.5F;                 // of the radius, what the curve explains,
constexpr float kNear_px = 1;                 // and this beyond
constexpr float kThick = 0.25F;   // half the thickness of what counts as a strand, widths
constexpr float kLong = 8;        // widths across, of a strand that is thinner
constexpr int kStraightStep = 3;  // chamfer distances 3-4, in thirds of a cell
constexpr int kDiagonalStep = 4;

/// The mask's box in cells, a few to a rope's width.
struct Cells {
  int stride_px = 1;
  int left_px = 0;
  int top_px = 0;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> left;  ///< [height, width] 1: mask, and no curve near
  std::size_t lit = 0;             ///< cells of the mask

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::count(left.begin(), left.end(), std::uint8_t{1}));
  }
  /// Index of the first one left from `from` on; as many as there are where none is.
  [[nodiscard]] std::size_t next(std::size_t from) const {
    const void* const found = std::memchr(left.data() + from, 1, left.size() - from);
    return found == nullptr
               ? left.size()
               : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - left.data());
  }
};

Cells mask_cells(const Frame& frame, float width_px) {
  Cells cells;
  cells.stride_px = std::max(1, static_cast<int>(width_px / kCellsAcross));
  const image::Rect box = geometry::mask_box(frame);
  if (box.empty()) return cells;
  cells.left_px = box.x;
  cells.top_px = box.y;
  cells.width = (box.width - 1) / cells.stride_px + 1;
  cells.height = (box.height - 1) / cells.stride_px + 1;
  cells.left.resize(cells.at(0, cells.height));
  for (int y = 0; y < cells.height; ++y) {
    const std::uint8_t* const row =
        frame.mask.data() + static_cast<std::size_t>(cells.top_px + y * cells.stride_px) *
                                static_cast<std::size_t>(frame.width);
    std::uint8_t* const to = cells.left.data() + cells.at(0, y);
    for (int x = 0; x < cells.width; ++x) {
      to[x] = row[cells.left_px + x * cells.stride_px] > kMaskThreshold ? 1 : 0;
    }
  }
  cells.lit = cells.count();
  return cells;
}

/// Takes away what lies near the curve.
void take_away(const ImageCurve& curve, float widening, Cells& cells) {
  const auto stride = static_cast<float>(cells.stride_px);
  for (const CurvePoint& point : curve.points) {
    const float reach = (kNear * widening * point.radius_px + kNear_px) / stride;
    const float x0 = (point.px.x() - static_cast<float>(cells.left_px)) / stride;
    const float y0 = (point.px.y() - static_cast<float>(cells.top_px)) / stride;
    const int first = std::max(0, static_cast<int>(std::ceil(y0 - reach)));
    const int last = std::min(cells.height - 1, static_cast<int>(std::floor(y0 + reach)));
    for (int y = first; y <= last; ++y) {
      const float off = static_cast<float>(y) - y0;
      const float half = std::sqrt(std::max(0.0F, reach * reach - off * off));
      const int from = std::max(0, static_cast<int>(std::ceil(x0 - half)));
      const int to = std::min(cells.width - 1, static_cast<int>(std::floor(x0 + half)));
      if (from <= to) {
        std::fill_n(cells.left.begin() + static_cast<std::ptrdiff_t>(cells.at(from, y)),
                    to - from + 1, std::uint8_t{0});
      }
    }
  }
}

/// [height, width] thirds of a cell to the nearest cell that is not left; outside there is none
/// left.
std::vector<std::int32_t> depths_within(const Cells& cells) {
  std::vector<std::int32_t> depth(cells.left.size(), 0);
  const auto at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < cells.width && y < cells.height;
    return inside ? depth[cells.at(x, y)] : 0;
  };
  const auto relax = [&](int x, int y, int way) {
    const std::int32_t straight = std::min(at(x - way, y), at(x, y - way)) + kStraightStep;
    const std::int32_t diagonal =
        std::min(at(x - way, y - way), at(x + way, y - way)) + kDiagonalStep;
    return std::min(straight, diagonal);
  };
  const auto width = static_cast<std::size_t>(cells.width);
  std::vector<std::size_t> left;
  for (std::size_t i = cells.next(0); i < cells.left.size(); i = cells.next(i + 1)) {
    depth[i] = relax(static_cast<int>(i % width), static_cast<int>(i / width), 1);
    left.push_back(i);
  }
  for (auto i = left.rbegin(); i != left.rend(); ++i) {
    const int back = relax(static_cast<int>(*i % width), static_cast<int>(*i / width), -1);
    depth[*i] = std::min(depth[*i], back);
  }
  return depth;
}

/// A piece of what is left, touching cells taken together.
struct Piece {
  std::size_t cells = 0;
  std::int32_t deepest = 0;  ///< thirds of a cell
  int across = 0;            ///< cells, of its box
};

/// Takes the piece at `seed` away.
Piece take_piece(std::size_t seed, const std::vector<std::int32_t>& depth, Cells& cells,
                 std::vector<std::size_t>& queue) {
  Piece piece;
  int left = cells.width;
  int right = 0;
  int top = cells.height;
  int bottom = 0;
  queue.assign(1, seed);
  cells.left[seed] = 0;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    piece.deepest = std::max(piece.deepest, depth[queue[next]]);
    const int x0 = static_cast<int>(queue[next] % static_cast<std::size_t>(cells.width));
    const int y0 = static_cast<int>(queue[next] / static_cast<std::size_t>(cells.width));
    left = std::min(left, x0);
    right = std::max(right, x0);
    top = std::min(top, y0);
    bottom = std::max(bottom, y0);
    for (int y = std::max(0, y0 - 1); y <= std::min(cells.height - 1, y0 + 1); ++y) {
      for (int x = std::max(0, x0 - 1); x <= std::min(cells.width - 1, x0 + 1); ++x) {
        if (cells.left[cells.at(x, y)] == 0) continue;
        cells.left[cells.at(x, y)] = 0;
        queue.push_back(cells.at(x, y));
      }
    }
  }
  piece.cells = queue.size();
  piece.across = std::max(right - left, bottom - top) + 1;
  return piece;
}

/// Length of the strands among what is left, widths: by their area where they are as thick as the
/// rope, by their box where they are thinner and long.
float strands_widths(Cells cells, float width_cells) {
  const std::vector<std::int32_t> depth = depths_within(cells);
  const auto thick = static_cast<std::int32_t>(kStraightStep * kThick * width_cells);
  float sum = 0;
  std::vector<std::size_t> queue;
  for (std::size_t seed = cells.next(0); seed < cells.left.size(); seed = cells.next(seed)) {
    const Piece piece = take_piece(seed, depth, cells, queue);
    const float across = static_cast<float>(piece.across) / width_cells;
    const float area = static_cast<float>(piece.cells) / (width_cells * width_cells);
    if (piece.deepest >= thick) {
      sum += area;
    } else if (across >= kLong) {
      sum += across;
    }
  }
  return sum;
}

}  // namespace

LeftOver left_over(const ImageCurve& curve, float widening, const Frame& frame) {
  Cells cells = mask_cells(frame, curve.width_px);
  if (cells.lit == 0) return {};
  take_away(curve, widening, cells);
  const std::size_t left = cells.count();
  const float width_cells = widening * curve.width_px / static_cast<float>(cells.stride_px);
  LeftOver result;
  result.explained = 1 - static_cast<float>(left) / static_cast<float>(cells.lit);
  result.strands_widths = strands_widths(std::move(cells), width_cells);
  return result;
}

}  // namespace flowdlo::gate
