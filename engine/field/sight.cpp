#include "field/sight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/depth.hpp"
#include "image/blur.hpp"
#include "image/resize.hpp"

namespace flowdlo::field {
namespace {

constexpr float kMost = 3;             // what a plane of the input holds at most
constexpr float kHalf = 0.5F;          // share of a pixel that makes it mask, or measured
constexpr float kLeastSpread = 0.05F;  // of a rope of one colour, 0 to 1
constexpr int kLeastColored = 20;      // rope pixels that tell its colour
constexpr int kCell_px = 16;           // of the grid on which the rope's depth is known
// What the cells around tell of it, three to each side: exact in binary.
const std::vector<float> kAround{0.03125F, 0.109375F, 0.21875F, 0.28125F,
                                 0.21875F, 0.109375F, 0.03125F};
constexpr float kFarWeight = 1e-4F;  // of the whole rope's depth, where no cell around has any
constexpr double kLevel = 0.03;      // cells squared of spread that a plane's slope is held to 0 by

template <class T>
image::Image<T> resampled(const image::Image<T>& given, const image::Size& size) {
  const bool smaller = size.width < given.width();
  return smaller ? image::area_mean<T>(given, size) : image::bilinear<T>(given, size);
}

/// The middle one; `values` is not empty and is reordered.
float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The rope's colour as the mask shows it, and how much it varies.
struct Palette {
  Color middle{};
  float spread = 1;
};

Palette palette_of(const Sight& sight) {
  std::vector<Color> seen;
  const auto collect = [&](bool mask_only) {
    seen.clear();
    for (int v = 0; v < sight.color.height(); ++v) {
      const auto* color = sight.color.row(v);
      const auto* mask = sight.mask.row(v);
      const auto* inside = sight.inside.row(v);
      for (int u = 0; u < sight.color.width(); ++u) {
        if (inside[u] > kHalf && (!mask_only || mask[u] > kHalf)) seen.push_back(color[u]);
      }
    }
  };
  collect(true);
  if (seen.size() < kLeastColored) collect(false);
  Palette palette;
  if (seen.empty()) return palette;
  double deviation = 0;
  std::vector<float> values(seen.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      values[i] = seen[i][k];
      sum += static_cast<double>(values[i]);
      squares += static_cast<double>(values[i]) * static_cast<double>(values[i]);
    }
    const auto count = static_cast<double>(seen.size());
    deviation += std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)) / 3;
    palette.middle[k] = median(values);
  }
  palette.spread = 2 * static_cast<float>(deviation) + kLeastSpread;
  return palette;
}

/// Sums over the cells around each cell, by how near they lie: of weights, of places about the
/// grid's corner, and of depths.
class Moments {
 public:
  explicit Moments(const image::Size& cells) {
    for (auto& sum : sums_) sum = image::Image<float>(cells, 0.0F);
  }

  void set(const image::Point& cell, float count, float depth_m) {
    const auto x = static_cast<float>(cell.x);
    const auto y = static_cast<float>(cell.y);
    const float weighed_m = count * depth_m;
    const std::array values{count,           count * x,       count * y,
                            count * (x * x), count * (x * y), count * (y * y),
                            weighed_m,       weighed_m * x,   weighed_m * y};
    for (std::size_t k = 0; k < kSums; ++k) sums_[k].at(cell) = values[k];
  }

  void gather() {
    for (auto& sum : sums_) sum = image::blurred(sum, kAround, image::Beyond::kZero);
  }

  /// At a cell: of the plane that fits the cells around best, all but level where they do not tell
  /// its slope; `far_m` where there are none.
  [[nodiscard]] float plane_m(const image::Point& cell, float far_m) const {
    const float weight = sums_[0].at(cell);
    const auto w = static_cast<double>(weight + kFarWeight);
    std::array<double, 5> p{};  // x, y, xx, xy, yy
    std::array<double, 3> d{};  // z, xz, yz
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = static_cast<double>(sums_[1 + k].at(cell));
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = static_cast<double>(sums_[6 + k].at(cell));
    const double x = cell.x;  // sums about the corner become means about this cell
    const double y = cell.y;
    const auto known = static_cast<double>(weight);
    const double mx = (p[0] - known * x) / w;
    const double my = (p[1] - known * y) / w;
    const double xx = (p[2] - 2 * x * p[0] + known * x * x) / w - mx * mx + kLevel;
    const double xy = (p[3] - x * p[1] - y * p[0] + known * x * y) / w - mx * my;
    const double yy = (p[4] - 2 * y * p[1] + known * y * y) / w - my * my + kLevel;
    const double z = (d[0] + static_cast<double>(kFarWeight * far_m)) / w;
    const double xz = (d[1] - x * d[0]) / w - mx * z;
    const double yz = (d[2] - y * d[0]) / w - my * z;
    const double determinant = xx * yy - xy * xy;  // at least kLevel squared
    const double slope_x = (yy * xz - xy * yz) / determinant;
    const double slope_y = (xx * yz - xy * xz) / determinant;
    return static_cast<float>(z - slope_x * mx - slope_y * my);
  }

 private:
  // The weight; x, y, xx, xy and yy, weighed, in cells; z, xz and yz, weighed, in metres and cells.
  static constexpr std::size_t kSums = 9;
  std::array<image::Image<float>, kSums> sums_;
};

/// Depth of the rope around each place, smooth: a plane through the medians of the cells of a grid,
/// for each cell its own. Occluders and holes weigh nothing, for they are no mask; a table seen
/// aslant leaves no steps, nor an error at the image's border. Empty where the mask has no depth at
/// all.
image::Image<float> rope_depth(const Sight& sight) {
  const image::Size size = sight.depth_m.size();
  const auto cells_in = [](int px) { return (px + kCell_px - 1) / kCell_px; };
  const image::Size cells{cells_in(size.width) + 2, cells_in(size.height) + 2};  // one around
  Moments moments(cells);
  std::vector<float> all;
  std::vector<float> values;
  for (int row = 1; row < cells.height - 1; ++row) {
    for (int column = 1; column < cells.width - 1; ++column) {
      values.clear();
      const image::Point corner{kCell_px * (column - 1), kCell_px * (row - 1)};
      for (int v = corner.y; v < std::min(size.height, corner.y + kCell_px); ++v) {
        for (int u = corner.x; u < std::min(size.width, corner.x + kCell_px); ++u) {
          const float z = sight.depth_m.at(v, u);
          if (z > 0 && sight.mask.at(v, u) > kHalf) values.push_back(z);
        }
      }
      if (values.empty()) continue;
      const float middle = median(values);
      all.push_back(middle);
      moments.set({column, row}, static_cast<float>(values.size()), middle);
    }
  }
  if (all.empty()) return {};
  const float whole = median(all);
  moments.gather();
  image::Image<float> coarse(cells);
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      coarse.at(row, column) = moments.plane_m({column, row}, whole);
    }
  }
  const auto fine = image::bilinear<float>(coarse, cells * kCell_px);
  return fine.part({kCell_px, kCell_px, size.width, size.height});
}

using Bgr = std::array<std::uint8_t, 3>;

/// Values from 0 to 1.
image::Image<Color> shares_of(const image::Image<const Bgr>& picture) {
  constexpr auto kScale = static_cast<float>(1.0 / 255);
  image::Image<Color> shares(picture.size());
  for (int v = 0; v < picture.height(); ++v) {
    std::transform(picture.row(v), picture.row(v) + picture.width(), shares.row(v),
                   [](const Bgr& at) {
                     return Color{at[0] * kScale, at[1] * kScale, at[2] * kScale};
                   });
  }
  return shares;
}

/// Whether a picture shows anything: one of a single colour, as a camera's stream that never began
/// is, does not.
bool varies(const image::Image<const Bgr>& picture) {
  const auto first = picture.at(0, 0);
  for (int v = 0; v < picture.height(); ++v) {
    const auto* row = picture.row(v);
    if (std::any_of(row, row + picture.width(), [&](const Bgr& at) { return at != first; })) {
      return true;
    }
  }
  return false;
}

/// A part of an image of the frame.
template <class T, class Stored>
image::Image<const T> part_of(std::span<const Stored> pixels, const Frame& frame,
                              const image::Rect& box) {
  const image::Image<const T> whole(reinterpret_cast<const T*>(pixels.data()),
                                    {frame.width, frame.height}, frame.width);
  return whole.part(box);
}

float within(float value) { return std::clamp(value, -kMost, kMost); }

}  // namespace

Sight look(const Frame& frame, const Region& region) {
  Sight sight;
  sight.focal_px = frame.intrinsics.fx * region.scale.x();
  {  // images of the frame's size go before the next ones come: they are large
    const auto mask = part_of<std::uint8_t>(frame.mask, frame, region.box);
    image::Image<float> covered(mask.size());
    for (int v = 0; v < mask.height(); ++v) {
      std::transform(mask.row(v), mask.row(v) + mask.width(), covered.row(v),
                     [](std::uint8_t value) { return value > 127 ? 1.0F : 0.0F; });
    }
    sight.mask = resampled(covered, region.size);
  }
  const auto depth_m = part_of<float>(frame.depth_m, frame, region.box);
  image::Image<float> measured(depth_m.size());
  image::Image<float> known(depth_m.size());
  for (int v = 0; v < depth_m.height(); ++v) {
    const auto* from = depth_m.row(v);
    for (int u = 0; u < depth_m.width(); ++u) {
      const bool good = geometry::measured(from[u]);
      measured.at(v, u) = good ? 1.0F : 0.0F;
      known.at(v, u) = good ? from[u] : 0.0F;
    }
  }
  const auto share = resampled(measured, region.size);
  measured = {};
  sight.depth_m = resampled(known, region.size);
  known = {};
  for (int v = 0; v < share.height(); ++v) {
    for (int u = 0; u < share.width(); ++u) {
      float& z = sight.depth_m.at(v, u);
      const float by = share.at(v, u);
      z = by > kHalf ? z / by : 0.0F;
    }
  }
  sight.inside = image::Image<float>(region.size, 1.0F);
  if (!frame.color_bgr.empty()) {
    const auto given = part_of<Bgr>(frame.color_bgr, frame, region.box);
    if (varies(given)) sight.color = resampled(shares_of(given), region.size);
  }
  return sight;
}

namespace {

/// Fills the planes of some pixels at a time.
class Filler {
 public:
  explicit Filler(const Sight& sight)
      : sight_(sight),
        palette_(sight.color.empty() ? Palette{} : palette_of(sight)),
        around_(rope_depth(sight)) {}

  void fill(const image::Rect& part, Planes& input) const {
    input.part(part).fill({});
    const bool has_color = !sight_.color.empty();
    for (int v = part.y; v < part.y + part.height; ++v) {
      const auto* inside = sight_.inside.row(v);
      const auto* mask = sight_.mask.row(v);
      const auto* depth = sight_.depth_m.row(v);
      for (int u = part.x; u < part.x + part.width; ++u) {
        if (inside[u] <= kHalf) continue;
        auto& to = input.at(v, u);
        if (has_color) {
          const auto& color = sight_.color.at(v, u);
          for (std::size_t k = 0; k < 3; ++k) {
            to[kBlue + k] = within((color[k] - palette_.middle[k]) / palette_.spread);
          }
          to[kHasColor] = 1;
        }
        if (depth[u] > 0 && !around_.empty()) {
          const float rope_m = around_.at(v, u);
          const float width_m = kRope_px * rope_m / sight_.focal_px;
          to[kDepth] = within((depth[u] - rope_m) / (2 * width_m));
          to[kHasDepth] = 1;
        }
        to[kMask] = mask[u];
      }
    }
  }

 private:
  const Sight& sight_;
  Palette palette_;
  image::Image<float> around_;
};

}  // namespace

Planes input_of(const Sight& sight) {
  Planes input(sight.mask.size());
  Filler(sight).fill(image::all_of(input.size()), input);
  return input;
}

Planes input_of(const Sight& sight, const BlockMap& blocks) {
  Planes input(sight.mask.size());
  const Filler filler(sight);
  for (const image::Point& block : blocks.blocks) {
    filler.fill(pixels_of(block) & image::all_of(input.size()), input);
  }
  return input;
}

}  // namespace flowdlo::field
