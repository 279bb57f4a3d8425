#include "prior/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "prior/contacts.hpp"

namespace flowdlo::prior {
namespace {

using Eigen::Vector2f;

constexpr float kLeastMerged = 1.5F;  // widths that the mask of two strands measures
constexpr float kMostMerged = 2.6F;
constexpr float kParallel = 0.75F;    // cosine between the strands
constexpr float kShortest = 2.5F;     // widths; a shorter stretch is a crossing
constexpr float kJumpWidths = 0.5F;   // from one station's neighbour to the next one's
constexpr float kApartWidths = 0.6F;  // strands this far apart show their sides
constexpr float kOnTopWidths = 0.3F;  // strands this near cross, or the path errs
constexpr float kClearWidths = 0.8F;  // strands this far apart are each on its own half
constexpr float kTouchUpWidths = 0.2F;
constexpr float kSmoothWidths = 0.5F;  // to both sides

class Strands {
 public:
  explicit Strands(const Strip& strip) : strip_(strip) {}

  [[nodiscard]] int count() const { return static_cast<int>(strip_.stations.size()); }
  [[nodiscard]] int stations_of(float widths) const {
    const float step = std::max(strip_.step_px, 1e-3F);
    return std::max(1, static_cast<int>(widths * strip_.width_px / step));
  }
  [[nodiscard]] const Station& at(int i) const {
    return strip_.stations[static_cast<std::size_t>(i)];
  }

  /// Where the strand runs alongside another one.
  [[nodiscard]] std::vector<Stretch> alongside() const {
    std::vector<Stretch> stretches;
    int before = -1;  // the last station's neighbour
    for (int i = 0; i < count(); ++i) {
      const int other = strip_.neighbour[static_cast<std::size_t>(i)];
      const bool runs = other >= 0 && std::abs(at(i).normal.dot(at(other).normal)) > kParallel;
      const bool on = runs && before >= 0 && std::abs(other - before) <= stations_of(kJumpWidths);
      if (runs && !on) stretches.push_back({i, i});
      if (on) stretches.back().last = i;
      before = runs ? other : -1;
    }
    std::erase_if(stretches, [this](const Stretch& stretch) {
      return stretch.last - stretch.first < stations_of(kShortest);
    });
    return stretches;
  }

  /// Where the other strand lies along the normal, widths.
  [[nodiscard]] float aside(int i) const {
    const int other = strip_.neighbour[static_cast<std::size_t>(i)];
    return (at(other).point_px - at(i).point_px).dot(at(i).normal) / strip_.width_px;
  }

  /// Whether the mask across the station is that of two strands.
  [[nodiscard]] bool merged(int i) const {
    const float wide = (at(i).left_px + at(i).right_px) / strip_.width_px;
    return at(i).bounded && wide > kLeastMerged && wide < kMostMerged;
  }

  /// On which side the other strand is before and after; 0 where they cross or nothing tells.
  [[nodiscard]] int side(const Stretch& stretch) const {
    const float before = aside(stretch.first);
    const float after = aside(stretch.last);
    if (std::min(std::abs(before), std::abs(after)) < kApartWidths || before * after < 0) return 0;
    for (int i = stretch.first; i <= stretch.last; ++i) {
      if (std::abs(aside(i)) < kOnTopWidths && !merged(i)) return 0;
    }
    return before > 0 ? 1 : -1;
  }

  /// How far the station has to move along its normal, the other strand being on `side`.
  [[nodiscard]] float move_px(int i, int side) const {
    if (!merged(i)) {  // the mask shows a slit: the strand may lie on its wrong side
      return aside(i) * static_cast<float>(side) < 0 ? aside(i) * strip_.width_px : 0;
    }
    const float quarter = 0.25F * (at(i).left_px + at(i).right_px);
    const float half = std::clamp(quarter, 0.4F * strip_.width_px, 0.6F * strip_.width_px);
    const float move = side > 0 ? half - at(i).left_px : at(i).right_px - half;
    // Strands already apart are at most moved a little: more, and a third one beside them is meant.
    const bool clear = aside(i) * static_cast<float>(side) > kClearWidths;
    return clear && std::abs(move) > kTouchUpWidths * strip_.width_px ? 0 : move;
  }

 private:
  const Strip& strip_;
};

}  // namespace

std::optional<std::vector<Vector2f>> side_by_side(const Strip& strip) {
  const Strands strands(strip);
  std::vector<float> moves(strip.stations.size(), 0.0F);
  bool any = false;
  for (const Stretch& stretch : strands.alongside()) {
    const int side = strands.side(stretch);
    if (side == 0) continue;
    for (int i = stretch.first; i <= stretch.last; ++i) {
      moves[static_cast<std::size_t>(i)] = strands.move_px(i, side);
      any = any || strands.merged(i);
    }
  }
  if (!any) return std::nullopt;
  std::vector<Vector2f> points;
  const int reach = strands.stations_of(kSmoothWidths);
  for (int i = 0; i < strands.count(); ++i) {
    const int first = std::max(0, i - reach);
    const int last = std::min(strands.count() - 1, i + reach);
    float sum = 0;
    for (int k = first; k <= last; ++k) sum += moves[static_cast<std::size_t>(k)];
    points.push_back(strands.at(i).point_px +
                     sum / static_cast<float>(last - first + 1) * strands.at(i).normal);
  }
  return points;
}

}  // namespace flowdlo::prior
