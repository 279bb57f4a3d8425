// Resampling: parts of an image at another size, several values a pixel at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/rect.hpp"

namespace flowdlo::field {

/// What given pixels, one after another, make up each wanted one along a row or a column.
class Taps {
 public:
  enum class Kind : std::uint8_t {
    kBetween,  ///< bilinear; beyond the outermost pixels' centres as it is there
    kCovers,   ///< likewise, between pixels that keep their value wherever they cover a whole one
    kMean,     ///< of what lies under it, where there are fewer wanted pixels than given ones
  };

  Taps(int given, int wanted, Kind kind);

  struct Tap {
    int given = 0;
    float share = 0;
  };
  [[nodiscard]] const Tap* begin(int wanted) const { return taps_.data() + first_[wanted]; }
  [[nodiscard]] const Tap* end(int wanted) const { return taps_.data() + first_[wanted + 1]; }

 private:
  std::vector<Tap> taps_;
  std::vector<int> first_;  // [wanted + 1] into `taps_`
};

/// As image::bilinear, or where rows become shorter as image::area_mean, but for rounding where
/// both sides are whole multiples.
class Resampling {
 public:
  Resampling(const image::Size& given, const image::Size& wanted);

  /// The given pixels that those of `part`, of the wanted image, are made of.
  [[nodiscard]] image::Rect source_of(const image::Rect& part) const;

  /// `to`: the pixels of `part`, with rows `stride` apart. `given` [source.height, source.width]
  /// holds those of `source`, which is source_of(part). `rows` is memory for values between.
  template <std::size_t kValues>
  void resample(const std::array<float, kValues>* given, const image::Rect& source,
                const image::Rect& part, std::array<float, kValues>* to, std::ptrdiff_t stride,
                std::vector<std::array<float, kValues>>& rows) const {
    const auto width = static_cast<std::size_t>(part.width);
    rows.resize(width * static_cast<std::size_t>(source.height));
    for (int v = 0; v < source.height; ++v) {
      const auto* const from = given + static_cast<std::ptrdiff_t>(v) * source.width - source.x;
      auto* const row = rows.data() + static_cast<std::size_t>(v) * width;
      for (int u = 0; u < part.width; ++u) {
        std::array<float, kValues> sum{};
        for (const auto* tap = columns_.begin(part.x + u); tap < columns_.end(part.x + u); ++tap) {
          const auto& pixel = from[tap->given];
          for (std::size_t k = 0; k < kValues; ++k) sum[k] += pixel[k] * tap->share;
        }
        row[u] = sum;
      }
    }
    for (int v = 0; v < part.height; ++v) {
      auto* const line = to + v * stride;
      std::fill_n(line, part.width, std::array<float, kValues>{});
      for (const auto* tap = rows_.begin(part.y + v); tap < rows_.end(part.y + v); ++tap) {
        const auto* const row =
            rows.data() + static_cast<std::size_t>(tap->given - source.y) * width;
        const float* const from = row->data();
        float* const sum = line->data();
        for (std::size_t i = 0; i < width * kValues; ++i) sum[i] += from[i] * tap->share;
      }
    }
  }

 private:
  Taps columns_;
  Taps rows_;
};

}  // namespace flowdlo::field
