#include "field/near_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "field/channel.hpp"
#include "field/surface.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::field {
namespace {

constexpr int kCell_px = 8;         // places over which a width is one: a rope's
constexpr float kRopeShown = 0.2F;  // of a pixel that counts
constexpr float kLeastRope = 1.0F;  // pixels of rope in a cell that tell its width
constexpr float kFrom = 0.35F;      // of the way from one look's width to the other's, where they
constexpr float kTo = 0.65F;        // begin to mix and end to

// Of the rope's pixels that are asked for a width. Chosen on 139 `several` training scenes (1000000
// to 1000149), of which 0.5 and 0.8 part as many ropes: the larger one costs less; training has
// shown the network up to one octave.
constexpr float kSure = 0.5F;            // is rope
constexpr float kWide = 0.8F;            // octaves beyond the expected width
constexpr float kLeastShare = 0.04F;     // so many of all are that wide, and
constexpr std::size_t kLeastAsked = 30;  // as many pixels

struct Cell {
  float rope = 0;
  float width = 0;  // sum over the rope
};

image::Image<Cell> cells_of(const Channels& field) {
  image::Image<Cell> cells(
      {(field.width() + kCell_px - 1) / kCell_px, (field.height() + kCell_px - 1) / kCell_px},
      Cell{});
  field.for_rows([&](int v, int first, const auto* at, int count) {
    Cell* row = cells.row(v / kCell_px);
    for (int i = 0; i < count; ++i) {
      const float rope = at[i][kRope];
      if (rope < kRopeShown) continue;
      row[(first + i) / kCell_px].rope += rope;
      row[(first + i) / kCell_px].width += rope * at[i][kWidth];
    }
  });
  return cells;
}

Cell around(const image::Image<Cell>& cells, int u, int v) {
  Cell sum;
  for (int y = std::max(0, v - 1); y <= std::min(v + 1, cells.height() - 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(u + 1, cells.width() - 1); ++x) {
      sum.rope += cells.at(y, x).rope;
      sum.width += cells.at(y, x).width;
    }
  }
  return sum;
}

}  // namespace

float wide_octaves(const Channels& field) {
  std::vector<float> wide;
  std::size_t rope = 0;
  field.for_rows([&](int, int, const auto* at, int count) {
    for (int i = 0; i < count; ++i) {
      if (at[i][kRope] <= kSure) continue;
      ++rope;
      if (at[i][kWidth] > kWide) wide.push_back(at[i][kWidth]);
    }
  });
  const auto least =
      std::max(static_cast<float>(kLeastAsked), kLeastShare * static_cast<float>(rope));
  return static_cast<float>(wide.size()) < least ? 0.0F : geometry::median_of(wide);
}

NearParts::NearParts(const Channels& field, float octaves) {
  const image::Image<Cell> cells = cells_of(field);
  cells_ = image::Image<float>(cells.size(), 0.0F);
  for (int v = 0; v < cells.height(); ++v) {
    for (int u = 0; u < cells.width(); ++u) {
      const Cell near = around(cells, u, v);
      if (near.rope < kLeastRope) continue;
      const float way = near.width / near.rope / octaves;
      cells_.at(v, u) = std::clamp((way - kFrom) / (kTo - kFrom), 0.0F, 1.0F);
    }
  }
}

float NearParts::share(int u, int v) const {
  const float x = (static_cast<float>(u) + 0.5F) / kCell_px - 0.5F;
  const float y = (static_cast<float>(v) + 0.5F) / kCell_px - 0.5F;
  const auto left = static_cast<int>(std::floor(x));
  const auto top = static_cast<int>(std::floor(y));
  float share = 0;
  for (const int row : {top, top + 1}) {
    for (const int column : {left, left + 1}) {
      const float weight = (1 - std::abs(x - static_cast<float>(column))) *
                           (1 - std::abs(y - static_cast<float>(row)));
      share += weight * cells_.at(std::clamp(row, 0, cells_.height() - 1),
                                  std::clamp(column, 0, cells_.width() - 1));
    }
  }
  return share;
}

BlockMap NearParts::needed(const BlockMap& blocks, const Region& other, const Region& base) const {
  image::Mask wanted({blocks.columns, blocks.rows}, 0);
  for (int v = 0; v < cells_.height(); ++v) {
    for (int u = 0; u < cells_.width(); ++u) {
      if (cells_.at(v, u) <= 0) continue;
      const auto corner = [&](int du, int dv) {
        const Eigen::Vector2f p = other.to_region(base.to_frame(
            {static_cast<float>((u + du) * kCell_px), static_cast<float>((v + dv) * kCell_px)}));
        return image::Point{static_cast<int>(std::floor(p.x() / static_cast<float>(kBlock_px))),
                            static_cast<int>(std::floor(p.y() / static_cast<float>(kBlock_px)))};
      };
      const image::Point first = corner(0, 0);
      const image::Point last = corner(1, 1);
      for (int y = std::max(0, first.y - 1); y <= std::min(last.y + 1, blocks.rows - 1); ++y) {
        for (int x = std::max(0, first.x - 1); x <= std::min(last.x + 1, blocks.columns - 1); ++x) {
          wanted.at(y, x) = 1;
        }
      }
    }
  }
  return those(blocks, [&](const image::Point& block) { return wanted.at(block) != 0; });
}

void blend(StrandField& field, const StrandField& other, const NearParts& parts, float octaves) {
  const Surface surface(other.channels);
  for (int v = 0; v < field.channels.height(); ++v) {
    for (int u = 0; u < field.channels.width(); ++u) {
      auto* const at = field.channels.find(v, u);
      const float share = at != nullptr ? parts.share(u, v) : 0;
      if (share <= 0) continue;
      const Eigen::Vector2f place = other.region.to_region(
          field.region.to_frame({static_cast<float>(u), static_cast<float>(v)}));
      const Surface::Spot spot = surface.spot(place);
      for (int c = 0; c < kChannels; ++c) {
        const float seen = spot.at(static_cast<Channel>(c)) + (c == kWidth ? octaves : 0.0F);
        (*at)[c] += share * (seen - (*at)[c]);
      }
    }
  }
}

}  // namespace flowdlo::field
