#include "pen.hpp"

#include <agg2/agg_conv_stroke.h>
#include <agg2/agg_ellipse.h>
#include <agg2/agg_gsv_text.h>
#include <agg2/agg_path_storage.h>
#include <agg2/agg_rasterizer_scanline_aa.h>
#include <agg2/agg_scanline_u.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "picture.hpp"

namespace flowdlo::tools {
namespace {

using support::Color;

constexpr double kHalf_px = 0.5;  // a pixel's centre lies there in Anti-Grain's coordinates
constexpr double kNothing_px = 1e-3;

std::uint8_t mixed(std::uint8_t below, std::uint8_t ink, unsigned cover) {
  return static_cast<std::uint8_t>((below * (255 - cover) + ink * cover + 127) / 255);
}

Color mixed(const Color& below, const Color& ink, unsigned cover) {
  return {mixed(below[0], ink[0], cover), mixed(below[1], ink[1], cover),
          mixed(below[2], ink[2], cover)};
}

/// Lays `ink` over what `shape`, a vertex source of Anti-Grain's, encloses.
template <class Shape, class Pixel>
void fill(image::Image<Pixel>& paper, Shape& shape, const Pixel& ink) {
  agg::rasterizer_scanline_aa<> rasterizer;
  rasterizer.clip_box(0, 0, paper.width(), paper.height());
  double x = 0;
  double y = 0;
  shape.rewind(0);
  for (unsigned command = shape.vertex(&x, &y); !agg::is_stop(command);
       command = shape.vertex(&x, &y)) {
    rasterizer.add_vertex(x, y, command);
  }
  if (!rasterizer.rewind_scanlines()) return;
  agg::scanline_u8 line;
  line.reset(rasterizer.min_x(), rasterizer.max_x());
  while (rasterizer.sweep_scanline(line)) {
    Pixel* const row = paper.row(line.y());
    auto span = line.begin();
    for (unsigned left = line.num_spans(); left > 0; --left, ++span) {
      for (int i = 0; i < span->len; ++i) {
        Pixel& pixel = row[span->x + i];
        pixel = mixed(pixel, ink, span->covers[i]);
      }
    }
  }
}

/// A line of that width along `path`.
template <class Path, class Pixel>
void draw(image::Image<Pixel>& paper, Path& path, double width_px, const Pixel& ink) {
  agg::conv_stroke<Path> line(path);
  line.width(width_px);
  line.line_cap(agg::round_cap);
  line.line_join(agg::round_join);
  line.inner_join(agg::inner_round);
  fill(paper, line, ink);
}

agg::ellipse circle(const Spot& center, double radius_px) {
  constexpr double kStep_px = 0.5;  // from corner to corner of the polygon that stands for it
  const double around_px = 2 * agg::pi * radius_px;
  const auto corners = static_cast<unsigned>(std::clamp(around_px / kStep_px, 16.0, 2000.0));
  return {static_cast<double>(center.x) + kHalf_px, static_cast<double>(center.y) + kHalf_px,
          radius_px, radius_px, corners};
}

bool in_one_place(std::span<const Spot> points) {
  return std::all_of(points.begin(), points.end(), [&](const Spot& point) {
    const auto step = point - points.front();
    return static_cast<double>(std::hypot(step.x, step.y)) < kNothing_px;
  });
}

/// The font has no others.
std::string printable(std::string words) {
  std::replace_if(
      words.begin(), words.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return words;
}

/// Anti-Grain's own font of lines, where `start` says.
void set(agg::gsv_text& text, const std::string& words, const Spot& start,
         const Lettering& lettering) {
  text.flip(true);  // rows run downwards
  text.size(static_cast<double>(lettering.height_px));
  text.start_point(static_cast<double>(start.x) + kHalf_px,
                   static_cast<double>(start.y) + kHalf_px);
  text.text(printable(words).c_str());
}

}  // namespace

float Lettering::width_px(const std::string& words) const {
  agg::gsv_text text;
  set(text, words, {}, *this);
  return static_cast<float>(text.text_width()) + line_px;
}

template <class Pixel>
void Pen<Pixel>::stroke(std::span<const Spot> points, float width_px, const Pixel& ink) {
  if (points.empty()) return;
  if (in_one_place(points)) return disc(points.front(), width_px / 2, ink);
  agg::path_storage path;
  for (const Spot& point : points) {
    const double x = static_cast<double>(point.x) + kHalf_px;
    const double y = static_cast<double>(point.y) + kHalf_px;
    if (path.total_vertices() == 0) {
      path.move_to(x, y);
    } else {
      path.line_to(x, y);
    }
  }
  draw(paper_, path, static_cast<double>(width_px), ink);
}

template <class Pixel>
void Pen<Pixel>::disc(const Spot& center, float radius_px, const Pixel& ink) {
  auto shape = circle(center, static_cast<double>(radius_px));
  fill(paper_, shape, ink);
}

template <class Pixel>
void Pen<Pixel>::ring(const Spot& center, float radius_px, float line_px, const Pixel& ink) {
  auto shape = circle(center, static_cast<double>(radius_px));
  draw(paper_, shape, static_cast<double>(line_px), ink);
}

template <class Pixel>
void Pen<Pixel>::write(const std::string& words, const Spot& start, const Lettering& lettering,
                       const Pixel& ink) {
  agg::gsv_text text;
  set(text, words, start, lettering);
  draw(paper_, text, static_cast<double>(lettering.line_px), ink);
}

template class Pen<Color>;
template class Pen<std::uint8_t>;

}  // namespace flowdlo::tools
