#include "field/sight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "geometry/depth.hpp"

namespace flowdlo::field {
namespace {

constexpr float kMost = 3;             // what a plane of the input holds at most
constexpr float kHalf = 0.5F;          // share of a pixel that makes it mask, or measured
constexpr float kLeastSpread = 0.05F;  // of a rope of one colour, 0 to 1
constexpr int kLeastColored = 20;      // rope pixels that tell its colour
constexpr int kCell_px = 16;           // of the grid on which the rope's depth is known
constexpr int kReach = 3;              // cells around that tell it
constexpr float kFarWeight = 1e-4F;    // of the whole rope's depth, where no cell around has any
constexpr double kLevel = 0.03;  // cells squared of spread that a plane's slope is held to 0 by

cv::Mat resampled(const cv::Mat& image, const cv::Size& size) {
  cv::Mat result;
  const bool smaller = size.width < image.cols;
  cv::resize(image, result, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
  return result;
}

/// The middle one; `values` is not empty and is reordered.
float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The rope's colour as the mask shows it, and how much it varies.
struct Palette {
  cv::Vec3f middle{0, 0, 0};
  float spread = 1;
};

Palette palette_of(const Sight& sight) {
  std::vector<cv::Vec3f> seen;
  const auto collect = [&](bool mask_only) {
    seen.clear();
    for (int v = 0; v < sight.color.rows; ++v) {
      const auto* color = sight.color.ptr<cv::Vec3f>(v);
      const auto* mask = sight.mask.ptr<float>(v);
      const auto* inside = sight.inside.ptr<float>(v);
      for (int u = 0; u < sight.color.cols; ++u) {
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
  for (int k = 0; k < 3; ++k) {
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
struct Moments {
  cv::Mat weight;  // f32, of one cell
  cv::Mat place;   // f32 x 5: x, y, xx, xy, yy, weighed; cells
  cv::Mat depth;   // f32 x 3: z, xz, yz, weighed; metres and cells

  explicit Moments(const cv::Size& cells)
      : weight(cv::Mat::zeros(cells, CV_32F)),
        place(cv::Mat::zeros(cells, CV_32FC(5))),
        depth(cv::Mat::zeros(cells, CV_32FC3)) {}

  void set(const cv::Point& cell, float count, float depth_m) {
    const auto x = static_cast<float>(cell.x);
    const auto y = static_cast<float>(cell.y);
    weight.at<float>(cell) = count;
    place.at<cv::Vec<float, 5>>(cell) = count * cv::Vec<float, 5>(x, y, x * x, x * y, y * y);
    depth.at<cv::Vec3f>(cell) = count * depth_m * cv::Vec3f(1, x, y);
  }

  void gather() {
    constexpr int kSide = 2 * kReach + 1;
    for (cv::Mat* sums : {&weight, &place, &depth}) {
      cv::GaussianBlur(*sums, *sums, {kSide, kSide}, 0, 0, cv::BORDER_CONSTANT);
    }
  }

  /// At a cell: of the plane that fits the cells around best, all but level where they do not tell
  /// its slope; `far_m` where there are none.
  [[nodiscard]] float plane_m(const cv::Point& cell, float far_m) const {
    const auto w = static_cast<double>(weight.at<float>(cell) + kFarWeight);
    const cv::Vec<double, 5> p = place.at<cv::Vec<float, 5>>(cell);
    const cv::Vec3d d = depth.at<cv::Vec3f>(cell);
    const double x = cell.x;  // sums about the corner become means about this cell
    const double y = cell.y;
    const auto known = static_cast<double>(weight.at<float>(cell));
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
};

/// Depth of the rope around each place, smooth: a plane through the medians of the cells of a grid,
/// for each cell its own. Occluders and holes weigh nothing, for they are no mask; a table seen
/// aslant leaves no steps, nor an error at the image's border. Empty where the mask has no depth at
/// all.
cv::Mat rope_depth(const Sight& sight) {
  const cv::Size size = sight.depth_m.size();
  const auto cells_in = [](int px) { return (px + kCell_px - 1) / kCell_px; };
  const cv::Size cells(cells_in(size.width) + 2, cells_in(size.height) + 2);  // one around
  Moments moments(cells);
  std::vector<float> all;
  std::vector<float> values;
  for (int row = 1; row < cells.height - 1; ++row) {
    for (int column = 1; column < cells.width - 1; ++column) {
      values.clear();
      const cv::Point corner(kCell_px * (column - 1), kCell_px * (row - 1));
      for (int v = corner.y; v < std::min(size.height, corner.y + kCell_px); ++v) {
        for (int u = corner.x; u < std::min(size.width, corner.x + kCell_px); ++u) {
          const float z = sight.depth_m.at<float>(v, u);
          if (z > 0 && sight.mask.at<float>(v, u) > kHalf) values.push_back(z);
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
  cv::Mat coarse(cells, CV_32F);
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      coarse.at<float>(row, column) = moments.plane_m({column, row}, whole);
    }
  }
  cv::Mat fine;
  cv::resize(coarse, fine, cells * kCell_px, 0, 0, cv::INTER_LINEAR);
  return fine(cv::Rect({kCell_px, kCell_px}, size));
}

/// Whether a picture shows anything: one of a single colour, as a camera's stream that never began
/// is, does not.
bool varies(const cv::Mat& bgr) {
  const auto first = bgr.at<cv::Vec3b>(0, 0);
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* row = bgr.ptr<cv::Vec3b>(v);
    if (std::any_of(row, row + bgr.cols, [&](const cv::Vec3b& at) { return at != first; })) {
      return true;
    }
  }
  return false;
}

float within(float value) { return std::clamp(value, -kMost, kMost); }

}  // namespace

Sight look(const Frame& frame, const Region& region) {
  const cv::Size size(frame.width, frame.height);
  const auto part = [&](int type, const void* data) {  // OpenCV has no view of constant pixels
    return cv::Mat(size, type, const_cast<void*>(data))(region.box);
  };
  Sight sight;
  sight.focal_px = frame.intrinsics.fx * region.scale.x();
  {  // images of the frame's size go before the next ones come: they are large
    cv::Mat covered;
    part(CV_8UC1, frame.mask.data()).convertTo(covered, CV_32F);
    cv::threshold(covered, covered, 127, 1, cv::THRESH_BINARY);
    sight.mask = resampled(covered, region.size);
  }
  const cv::Mat depth_m = part(CV_32FC1, frame.depth_m.data());
  cv::Mat measured(depth_m.size(), CV_32F);
  cv::Mat known(depth_m.size(), CV_32F);
  for (int v = 0; v < depth_m.rows; ++v) {
    const auto* from = depth_m.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; ++u) {
      const bool good = geometry::measured(from[u]);
      measured.at<float>(v, u) = good ? 1.0F : 0.0F;
      known.at<float>(v, u) = good ? from[u] : 0.0F;
    }
  }
  const cv::Mat share = resampled(measured, region.size);
  measured.release();
  sight.depth_m = resampled(known, region.size);
  known.release();
  for (int v = 0; v < share.rows; ++v) {
    for (int u = 0; u < share.cols; ++u) {
      float& z = sight.depth_m.at<float>(v, u);
      const float by = share.at<float>(v, u);
      z = by > kHalf ? z / by : 0.0F;
    }
  }
  sight.inside = cv::Mat::ones(region.size, CV_32F);
  if (!frame.color_bgr.empty()) {
    const cv::Mat given = part(CV_8UC3, frame.color_bgr.data());
    if (varies(given)) {
      cv::Mat color;
      given.convertTo(color, CV_32F, 1.0 / 255);
      sight.color = resampled(color, region.size);
    }
  }
  return sight;
}

namespace {

/// Fills the planes of some pixels at a time.
class Planes {
 public:
  explicit Planes(const Sight& sight)
      : sight_(sight),
        palette_(sight.color.empty() ? Palette{} : palette_of(sight)),
        around_(rope_depth(sight)) {}

  void fill(const cv::Rect& part, cv::Mat& input) const {
    input(part).setTo(0);
    const bool has_color = !sight_.color.empty();
    for (int v = part.y; v < part.y + part.height; ++v) {
      auto* to = input.ptr<float>(v) + part.x * kPlanes;
      const auto* inside = sight_.inside.ptr<float>(v);
      const auto* mask = sight_.mask.ptr<float>(v);
      const auto* depth = sight_.depth_m.ptr<float>(v);
      for (int u = part.x; u < part.x + part.width; ++u, to += kPlanes) {
        if (inside[u] <= kHalf) continue;
        if (has_color) {
          const auto& color = sight_.color.at<cv::Vec3f>(v, u);
          for (int k = 0; k < 3; ++k) {
            to[kBlue + k] = within((color[k] - palette_.middle[k]) / palette_.spread);
          }
          to[kHasColor] = 1;
        }
        if (depth[u] > 0 && !around_.empty()) {
          const float rope_m = around_.at<float>(v, u);
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
  cv::Mat around_;
};

}  // namespace

cv::Mat input_of(const Sight& sight) {
  cv::Mat input(sight.mask.size(), CV_32FC(kPlanes));
  Planes(sight).fill(cv::Rect({0, 0}, input.size()), input);
  return input;
}

cv::Mat input_of(const Sight& sight, const BlockMap& blocks) {
  cv::Mat input(sight.mask.size(), CV_32FC(kPlanes));
  const Planes planes(sight);
  for (const cv::Point& block : blocks.blocks) {
    planes.fill(pixels_of(block) & cv::Rect({0, 0}, input.size()), input);
  }
  return input;
}

}  // namespace flowdlo::field
