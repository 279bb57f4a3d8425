#include "one_rope/odd_mask.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scene/random.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::array<double, 11> kDensities{0.01, 0.05, 0.1, 0.2, 0.3, 0.5,
                                            0.6,  0.7,  0.8, 0.9, 0.99};
constexpr int kGlyphWidth = 5;
constexpr int kGlyphHeight = 7;

/// "ROPE CABLE", one bit a dot, the top row first, the left dot highest.
constexpr std::array<std::array<std::uint8_t, kGlyphHeight>, 10> kGlyphs{{
    {0x1E, 0x11, 0x11, 0x1E, 0x14, 0x12, 0x11},  // R
    {0x0E, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E},  // O
    {0x1E, 0x11, 0x11, 0x1E, 0x10, 0x10, 0x10},  // P
    {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x1F},  // E
    {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00},
    {0x0E, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0E},  // C
    {0x0E, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11},  // A
    {0x1E, 0x11, 0x11, 0x1E, 0x11, 0x11, 0x1E},  // B
    {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1F},  // L
    {0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x1F},  // E
}};

/// A word and the first characters of a number.
std::string named(const char* word, double number, int digits) {
  std::string name(word);
  name.append(1, ' ').append(std::to_string(number), 0, static_cast<std::size_t>(digits));
  return name;
}

class Painter {
 public:
  Painter(int width, int height) : width_(width), height_(height) {}

  /// Lit where `is_lit(u, v)`.
  template <class Lit>
  void paint(std::string name, const Lit& is_lit) {
    OddMask odd{std::move(name), {}};
    odd.mask.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) odd.mask.push_back(is_lit(u, v) ? 255 : 0);
    }
    masks.push_back(std::move(odd));
  }

  std::vector<OddMask> masks;

 private:
  int width_;
  int height_;
};

void paint_noise(Painter& painter) {
  for (const double density : kDensities) {
    for (const int grain : {1, 3, 8}) {
      Random random(static_cast<std::uint64_t>(1000 * density) + static_cast<std::uint64_t>(grain));
      std::vector<char> row;
      painter.paint(named("noise", density, 4) + named(" of", grain, 1) + " px", [&](int u, int v) {
        const auto cell = static_cast<std::size_t>(u / grain);
        if (u % grain == 0 && v % grain == 0) {
          row.resize(std::max(row.size(), cell + 1));
          row[cell] = random.chance(density) ? 1 : 0;
        }
        return row[cell] != 0;
      });
    }
  }
}

void paint_blobs(int width, int height, Painter& painter) {
  const double w = width;
  const double h = height;
  painter.paint("full", [](int, int) { return true; });
  painter.paint("left half", [&](int u, int) { return u < width / 2; });
  painter.paint("frame", [&](int u, int v) {
    return u < width / 5 || v < height / 5 || u >= width - width / 5 || v >= height - height / 5;
  });
  painter.paint("disc", [&](int u, int v) { return std::hypot(u - w / 2, v - h / 2) < h / 3; });
  painter.paint("ellipse", [&](int u, int v) {
    return std::hypot((u - w / 2) / (w * 0.4), (v - h / 2) / (h * 0.2)) < 1;
  });
  painter.paint("block", [&](int u, int v) {
    return std::abs(u - w / 2) < w * 0.3 && std::abs(v - h / 2) < h * 0.2;
  });
  for (const double scale : {0.02, 0.04, 0.08}) {
    painter.paint(named("clouds", scale, 4), [=](int u, int v) {
      return std::sin(scale * u + 1) + std::sin(1.3 * scale * v + 2 * std::sin(0.7 * scale * u)) +
                 std::sin(0.8 * scale * (u + v)) >
             0.3;
    });
  }
  painter.paint("hand", [&](int u, int v) {
    const bool palm = std::hypot((u - w / 2) / (h * 0.2), (v - h * 0.65) / (h * 0.25)) < 1;
    bool finger = false;
    for (int k = -2; k <= 2; ++k) {
      finger =
          finger || (std::abs(u - w / 2 - k * h * 0.09) < h * 0.035 && v > h * 0.15 && v < h * 0.6);
    }
    return palm || finger;
  });
}

void paint_patterns(int width, int height, Painter& painter) {
  for (const int pitch : {4, 16, 48}) {
    const std::string size = named("", pitch, pitch < 10 ? 1 : 2) + " px";
    painter.paint("checkers" + size,
                  [=](int u, int v) { return (u / pitch + v / pitch) % 2 == 0; });
    painter.paint("grid" + size, [=](int u, int v) {
      return u % pitch < std::max(1, pitch / 4) || v % pitch < std::max(1, pitch / 4);
    });
    painter.paint("stripes" + size, [=](int u, int) { return u % pitch < pitch / 2; });
    painter.paint("comb" + size,
                  [=](int u, int v) { return v < pitch || u % pitch < std::max(1, pitch / 3); });
    painter.paint("dots" + size, [=](int u, int v) {
      return std::hypot(u % pitch - pitch / 2.0, v % pitch - pitch / 2.0) < pitch / 3.0;
    });
  }
  for (const int dot : {3, 6}) {
    painter.paint(named("text of", dot, 1) + " px", [=](int u, int v) {
      const int x = u / dot;
      const int y = v / dot - 2;
      const int row = y % (kGlyphHeight + 3);
      const int column = x % (kGlyphWidth + 1);
      if (y < 0 || row >= kGlyphHeight || column >= kGlyphWidth) return false;
      const auto& glyph = kGlyphs[static_cast<std::size_t>(x / (kGlyphWidth + 1)) % kGlyphs.size()];
      return (glyph[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1) != 0;
    });
  }
  const double h = height;
  const double w = width;
  painter.paint("rings", [=](int u, int v) {
    return static_cast<int>(std::hypot(u - w / 2, v - h / 2)) % 24 < 10;
  });
  painter.paint("star", [=](int u, int v) {
    const double angle = std::atan2(v - h / 2, u - w / 2);
    const double reach = std::hypot(u - w / 2, v - h / 2);
    return reach < h * 0.4 && std::abs(std::sin(3.5 * angle)) * reach < 6;
  });
  painter.paint("tree", [=](int u, int v) {
    const double y = v - h * 0.1;
    if (y < 0 || y > h * 0.8) return false;
    const double branch = std::fmod(y, h * 0.1);
    const double side = std::abs(u - w / 2);
    return side < 5 || (side < w * 0.3 && std::abs(branch - side * 0.2) < 5);
  });
}

}  // namespace

std::vector<OddMask> odd_masks(int width, int height) {
  Painter painter(width, height);
  paint_blobs(width, height, painter);
  paint_noise(painter);
  paint_patterns(width, height, painter);
  return std::move(painter.masks);
}

}  // namespace flowdlo::lab
