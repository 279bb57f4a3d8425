#include "image/resize.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "image/between.hpp"

namespace flowdlo::image {
namespace {

/// A pixel as its values.
template <class T>
struct Values {
  using Value = T;
  static constexpr int kCount = 1;
};
template <std::size_t kChannels>
struct Values<std::array<float, kChannels>> {
  using Value = float;
  static constexpr int kCount = static_cast<int>(kChannels);
};

template <class T>
const typename Values<T>::Value* values(const T* row) {
  return reinterpret_cast<const typename Values<T>::Value*>(row);
}
template <class T>
typename Values<T>::Value* values(T* row) {
  return reinterpret_cast<typename Values<T>::Value*>(row);
}

float stored(float value, float /*as*/) { return value; }
std::uint8_t stored(float value, std::uint8_t /*as*/) {
  return static_cast<std::uint8_t>(std::clamp(std::lrint(value), 0L, 255L));
}

/// Pixels of the given size for each of the wanted one.
double scale_of(int given, int wanted) {
  return 1 / (static_cast<double>(wanted) / static_cast<double>(given));
}

std::vector<Between> places(int given, int wanted, bool covers) {
  const double inverse = static_cast<double>(wanted) / given;
  const double scale = 1 / inverse;
  std::vector<Between> result(static_cast<std::size_t>(wanted));
  for (int at = 0; at < wanted; ++at) {
    result[static_cast<std::size_t>(at)] =
        covers ? cover_of(at, scale, inverse) : centre_of(at, scale);
  }
  return result;
}

/// Two rows between which a row lies, each already at its new width.
template <class T>
class WideRows {
 public:
  static constexpr int kCount = Values<T>::kCount;

  WideRows(const Image<const T>& image, int width, bool covers)
      : image_(image), columns_(places(image.width(), width, covers)) {
    for (Between& column : columns_) {
      if (column.first < 0) column = {0, 0};
      if (column.first >= image.width() - 1) column = {image.width() - 1, 0};
    }
    for (Row& row : rows_) row.values.resize(columns_.size() * kCount);
  }

  const float* at(int v, int other) {
    v = std::clamp(v, 0, image_.height() - 1);
    for (const Row& row : rows_) {
      if (row.number == v) return row.values.data();
    }
    other = std::clamp(other, 0, image_.height() - 1);
    Row& free = rows_[0].number == other ? rows_[1] : rows_[0];
    free.number = v;
    const float* const from = values(image_.row(v));
    float* to = free.values.data();
    for (const Between& column : columns_) {
      const float* const one = from + column.first * kCount;
      const float* const next = column.share == 0 ? one : one + kCount;
      for (int c = 0; c < kCount; ++c) *to++ = one[c] * (1 - column.share) + next[c] * column.share;
    }
    return free.values.data();
  }

 private:
  struct Row {
    int number = -1;
    std::vector<float> values;
  };

  const Image<const T>& image_;
  std::vector<Between> columns_;
  std::array<Row, 2> rows_;
};

template <class T>
Image<T> between(const Image<const T>& image, const Size& size, bool covers) {
  WideRows<T> wide(image, size.width, covers);
  const std::vector<Between> rows = places(image.height(), size.height, covers);
  Image<T> result(size);
  for (int v = 0; v < size.height; ++v) {
    const auto& [first, share] = rows[static_cast<std::size_t>(v)];
    const float* const upper = wide.at(first, first + 1);
    const float* const lower = wide.at(first + 1, first);
    float* const to = values(result.row(v));
    for (int i = 0; i < size.width * WideRows<T>::kCount; ++i) {
      to[i] = upper[i] * (1 - share) + lower[i] * share;
    }
  }
  return result;
}

/// A given pixel's part of a wanted one.
struct Part {
  int given = 0;
  int wanted = 0;
  float share = 0;
};

std::vector<Part> parts(int given, int wanted) {
  constexpr double kLeast = 1e-3;  // of a pixel, that counts
  const double scale = scale_of(given, wanted);
  std::vector<Part> result;
  for (int at = 0; at < wanted; ++at) {
    const double from = at * scale;
    const double to = from + scale;
    const double whole = std::min(scale, given - from);
    const int last = std::min(static_cast<int>(std::floor(to)), given - 1);
    const int first = std::min(static_cast<int>(std::ceil(from)), last);
    if (first - from > kLeast) {
      result.push_back({first - 1, at, static_cast<float>((first - from) / whole)});
    }
    for (int i = first; i < last; ++i) result.push_back({i, at, static_cast<float>(1 / whole)});
    if (to - last > kLeast) {
      const double rest = std::min({to - last, 1.0, whole});
      result.push_back({last, at, static_cast<float>(rest / whole)});
    }
  }
  return result;
}

template <class T>
Image<T> mean_of_parts(const Image<const T>& image, const Size& size) {
  constexpr int kCount = Values<T>::kCount;
  const std::vector<Part> columns = parts(image.width(), size.width);
  const std::vector<Part> rows = parts(image.height(), size.height);
  const auto count = static_cast<std::size_t>(size.width) * kCount;
  std::vector<float> along(count);
  std::vector<float> sum(count, 0.0F);
  Image<T> result(size);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Part& row = rows[r];
    const auto* const from = values(image.row(row.given));
    std::fill(along.begin(), along.end(), 0.0F);
    for (const Part& column : columns) {
      for (int c = 0; c < kCount; ++c) {
        along[static_cast<std::size_t>(column.wanted * kCount + c)] +=
            static_cast<float>(from[column.given * kCount + c]) * column.share;
      }
    }
    const bool begins = r == 0 || rows[r - 1].wanted != row.wanted;
    for (std::size_t i = 0; i < count; ++i) {
      sum[i] = begins ? row.share * along[i] : sum[i] + row.share * along[i];
    }
    if (r + 1 < rows.size() && rows[r + 1].wanted == row.wanted) continue;
    auto* const to = values(result.row(row.wanted));
    for (std::size_t i = 0; i < count; ++i) to[i] = stored(sum[i], to[i]);
  }
  return result;
}

// The sum of a block's values, four at a time.
float block_sum(const float* from, std::ptrdiff_t stride, int step, int width, int height) {
  float sum = 0;
  float four = 0;
  int have = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = from[y * stride + x * step];
      const bool single = y * width + x >= width * height / 4 * 4;
      four = have == 0 ? value : four + value;
      if (++have < 4 && !single) continue;
      sum += four;
      have = 0;
    }
  }
  return sum;
}
int block_sum(const std::uint8_t* from, std::ptrdiff_t stride, int step, int width, int height) {
  int sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) sum += from[y * stride + x * step];
  }
  return sum;
}

// Blocks of whole pixels.
template <class T>
Image<T> mean_of_blocks(const Image<const T>& image, const Size& size) {
  using Value = typename Values<T>::Value;
  constexpr int kCount = Values<T>::kCount;
  const int width = image.width() / size.width;
  const int height = image.height() / size.height;
  const float share = 1.0F / static_cast<float>(width * height);
  const bool fours = width == 2 && height == 2;
  const std::ptrdiff_t stride = image.stride() * kCount;
  Image<T> result(size);
  for (int v = 0; v < size.height; ++v) {
    const Value* const from = values(image.row(v * height));
    Value* const to = values(result.row(v));
    for (int i = 0; i < size.width * kCount; ++i) {
      const Value* const first = from + (i / kCount * width) * kCount + i % kCount;
      if constexpr (std::is_same_v<Value, std::uint8_t>) {
        const int sum = block_sum(first, stride, kCount, width, height);
        to[i] = fours ? static_cast<std::uint8_t>((sum + 2) / 4)
                      : stored(static_cast<float>(sum) * share, to[i]);
      } else if (fours && kCount == 1 && i < size.width / 4 * 4) {  // the order that OpenCV adds in
        to[i] = ((first[0] + first[1]) + (first[stride] + first[stride + 1])) * share;
      } else {
        to[i] = block_sum(first, stride, kCount, width, height) * share;
      }
    }
  }
  return result;
}

bool whole(int given, int wanted) {
  const double scale = scale_of(given, wanted);
  return std::abs(scale - std::round(scale)) < std::numeric_limits<double>::epsilon();
}

}  // namespace

template <class T>
Image<T> nearest(const Image<const T>& image, const Size& size) {
  const double scale_u = scale_of(image.width(), size.width);
  const double scale_v = scale_of(image.height(), size.height);
  const auto under = [](int at, double scale, int count) {
    return std::min(static_cast<int>(std::floor(at * scale)), count - 1);
  };
  std::vector<int> columns(static_cast<std::size_t>(size.width));
  for (int u = 0; u < size.width; ++u) {
    columns[static_cast<std::size_t>(u)] = under(u, scale_u, image.width());
  }
  Image<T> result(size);
  int before = -1;
  for (int v = 0; v < size.height; ++v) {
    const int from = under(v, scale_v, image.height());
    if (from == before) {
      std::copy_n(result.row(v - 1), size.width, result.row(v));
      continue;
    }
    const T* const row = image.row(from);
    T* const to = result.row(v);
    for (int u = 0; u < size.width; ++u) to[u] = row[columns[static_cast<std::size_t>(u)]];
    before = from;
  }
  return result;
}

template <class T>
Image<T> bilinear(const Image<const T>& image, const Size& size) {
  if (size == image.size()) return image.clone();
  return between(image, size, false);
}

template <class T>
Image<T> area_mean(const Image<const T>& image, const Size& size) {
  if (size == image.size()) return image.clone();
  if (size.width > image.width() || size.height > image.height()) {
    if constexpr (std::is_same_v<T, std::uint8_t>) {
      return nearest<T>(image, size);
    } else {
      return between(image, size, true);
    }
  }
  if (whole(image.width(), size.width) && whole(image.height(), size.height)) {
    return mean_of_blocks(image, size);
  }
  return mean_of_parts(image, size);
}

using Three = std::array<float, 3>;
template Image<std::uint8_t> nearest(const Image<const std::uint8_t>&, const Size&);
template Image<std::uint16_t> nearest(const Image<const std::uint16_t>&, const Size&);
template Image<float> nearest(const Image<const float>&, const Size&);
template Image<float> bilinear(const Image<const float>&, const Size&);
template Image<Three> bilinear(const Image<const Three>&, const Size&);
template Image<std::uint8_t> area_mean(const Image<const std::uint8_t>&, const Size&);
template Image<float> area_mean(const Image<const float>&, const Size&);
template Image<Three> area_mean(const Image<const Three>&, const Size&);

}  // namespace flowdlo::image
