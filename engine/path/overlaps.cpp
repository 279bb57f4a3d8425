#include "path/overlaps.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kCell_px = 8;       // of a grid to find what is near
constexpr float kSameWay = 0.7F;    // cosine between two ways that are one, at least
constexpr std::size_t kAround = 3;  // points before and behind one that tell its way

struct Place {
  int strand = 0;
  Vector2f px;
  Vector2f way;  // a unit, or 0
};

using Cell = std::pair<int, int>;  // row and column

int cell_of(float px) { return static_cast<int>(std::floor(px / kCell_px)); }

Vector2f way_at(const std::vector<Vector2f>& points, std::size_t i) {
  const Vector2f& from = points[i - std::min(i, kAround)];
  const Vector2f& to = points[std::min(i + kAround, points.size() - 1)];
  return (to - from).normalized();  // Eigen leaves a vector of no length as it is
}

}  // namespace

Overlaps::Overlaps(const Strands& strands) : on_(strands.list.size()) {
  std::map<Cell, std::vector<Place>> cells;
  std::vector<float> widths;
  for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
    const auto& points = strands.list[s].points_px;
    widths.push_back(width_px_of(strands.list[s], strands));
    for (std::size_t i = 0; i < points.size(); ++i) {
      cells[{cell_of(points[i].y()), cell_of(points[i].x())}].push_back(
          {s, points[i], way_at(points, i)});
    }
  }
  const float widest = widths.empty() ? 0 : *std::max_element(widths.begin(), widths.end());
  const auto lies_on = [&](const Place& a, const Place& b) {
    const float apart = kOnEachOther * 0.5F * (widths[a.strand] + widths[b.strand]);
    return a.strand != b.strand && (a.px - b.px).squaredNorm() <= apart * apart &&
           std::abs(a.way.dot(b.way)) >= kSameWay;
  };
  for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
    const auto& points = strands.list[s].points_px;
    const float reach = kOnEachOther * 0.5F * (widths[s] + widest);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Place own{s, points[i], way_at(points, i)};
      std::vector<int>& others = on_[s].emplace_back();
      for (int row = cell_of(own.px.y() - reach); row <= cell_of(own.px.y() + reach); ++row) {
        const int last = cell_of(own.px.x() + reach);
        auto cell = cells.lower_bound({row, cell_of(own.px.x() - reach)});
        for (; cell != cells.end() && cell->first <= Cell{row, last}; ++cell) {
          for (const Place& other : cell->second) {
            if (lies_on(own, other)) others.push_back(other.strand);
          }
        }
      }
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
    }
  }
}

float Overlaps::bare_share(int strand, const std::vector<std::uint8_t>& used) const {
  const auto& points = on_[strand];
  if (points.empty()) return 1;
  const auto bare = std::count_if(points.begin(), points.end(), [&](const std::vector<int>& here) {
    return std::none_of(here.begin(), here.end(), [&](int other) { return used[other] != 0; });
  });
  return static_cast<float>(bare) / static_cast<float>(points.size());
}

}  // namespace flowdlo::path
