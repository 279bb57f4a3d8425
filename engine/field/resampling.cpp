#include "field/resampling.hpp"

#include <algorithm>
#include <cmath>

#include "image/between.hpp"

namespace flowdlo::field {
namespace {

using Kind = Taps::Kind;

using List = std::vector<Taps::Tap>;

void add_between(int given, int at, double inverse, Kind kind, List& taps) {
  const double scale = 1 / inverse;
  const auto [first, share] =
      kind == Kind::kCovers ? image::cover_of(at, scale, inverse) : image::centre_of(at, scale);
  if (first < 0 || first >= given - 1 || share == 0) {
    taps.push_back({std::clamp(first, 0, given - 1), 1});
    return;
  }
  taps.push_back({first, 1 - share});
  taps.push_back({first + 1, share});
}

void add_under(int given, int at, double scale, List& taps) {
  constexpr double kLeast = 1e-3;  // of a pixel, that counts
  const double from = at * scale;
  const double to = from + scale;
  const double whole = std::min(scale, given - from);
  const int last = std::min(static_cast<int>(std::floor(to)), given - 1);
  const int first = std::min(static_cast<int>(std::ceil(from)), last);
  if (first - from > kLeast) {
    taps.push_back({first - 1, static_cast<float>((first - from) / whole)});
  }
  for (int i = first; i < last; ++i) taps.push_back({i, static_cast<float>(1 / whole)});
  if (to - last > kLeast) {
    const double rest = std::min({to - last, 1.0, whole});
    taps.push_back({last, static_cast<float>(rest / whole)});
  }
}

Kind kind_for(const image::Size& given, const image::Size& wanted) {
  if (wanted.width >= given.width) return Kind::kBetween;
  return wanted.height > given.height ? Kind::kCovers : Kind::kMean;
}

}  // namespace

Taps::Taps(int given, int wanted, Kind kind) : first_{0} {
  const double inverse = static_cast<double>(wanted) / given;
  for (int at = 0; at < wanted; ++at) {
    if (kind == Kind::kMean) {
      add_under(given, at, 1 / inverse, taps_);
    } else {
      add_between(given, at, inverse, kind, taps_);
    }
    first_.push_back(static_cast<int>(taps_.size()));
  }
}

Resampling::Resampling(const image::Size& given, const image::Size& wanted)
    : columns_(given.width, wanted.width, kind_for(given, wanted)),
      rows_(given.height, wanted.height, kind_for(given, wanted)) {}

image::Rect Resampling::source_of(const image::Rect& part) const {
  const int left = columns_.begin(part.x)->given;
  const int right = (columns_.end(part.x + part.width - 1) - 1)->given;
  const int top = rows_.begin(part.y)->given;
  const int bottom = (rows_.end(part.y + part.height - 1) - 1)->given;
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace flowdlo::field
