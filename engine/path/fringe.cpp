#include "path/fringe.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/components.hpp"
#include "image/distance.hpp"

namespace flowdlo::path {
namespace {

constexpr int kLeastDark = 24;        // pixels of dark line; fewer are no outline
constexpr float kLeastHalfPx = 2;     // of a rope beside which slivers can be told
constexpr float kThinShare = 0.5F;    // of the rope's half width: a sliver's, at most
constexpr float kThickShare = 0.8F;   // and the least of what it lies beside
constexpr float kGapPx = 2.5F;        // between the edges of sliver and rope
constexpr float kSmallArea = 10.0F;   // half widths squared: of a crumb, at most
constexpr int kManySlivers = 4;       // beside so many, crumbs as thick as the rope are fringe too
constexpr float kBesideShare = 0.8F;  // of a sliver's pixels that lie that near

// Empty pixels between two of the mask: what a dark line is made of.
int count_dark(const image::Mask& mask) {
  int dark = 0;
  for (int v = 1; v + 1 < mask.height(); ++v) {
    const std::uint8_t* up = mask.row(v - 1);
    const std::uint8_t* row = mask.row(v);
    const std::uint8_t* down = mask.row(v + 1);
    for (int u = 1; u + 1 < mask.width(); ++u) {
      dark += (row[u] ^ 1) & ((row[u - 1] & row[u + 1]) | (up[u] & down[u]));
    }
  }
  return dark;
}

// Half the thickness that half of the mask's area has at least.
float usual_half_px(const image::Image<float>& distance) {
  std::vector<float> ridge;
  double area = 0;
  image::for_ridges(distance, [&](float d) {
    ridge.push_back(d);
    area += static_cast<double>(d);
  });
  std::sort(ridge.begin(), ridge.end());
  double sum = 0;
  for (const float d : ridge) {
    sum += static_cast<double>(d);
    if (sum >= 0.5 * area) return d;
  }
  return 0;
}

struct Piece {
  float half_px = 0;  // at its thickest
  int pixels = 0;
  int beside = 0;  // of them near a thick piece
};

// The pieces of the mask, by label; `labels` is 0 where it is empty.
std::vector<Piece> measure(const image::Image<int>& labels, int count, float half_px,
                           image::Image<float>& distance) {
  std::vector<Piece> pieces(static_cast<std::size_t>(count));
  const auto each = [&](auto visit) {
    for (int v = 0; v < labels.height(); ++v) {
      const int* label = labels.row(v);
      for (int u = 0; u < labels.width(); ++u) {
        if (label[u] != 0) visit(pieces[static_cast<std::size_t>(label[u])], v, u);
      }
    }
  };
  each([&](Piece& piece, int v, int u) {
    piece.half_px = std::max(piece.half_px, distance.at(v, u));
    ++piece.pixels;
  });
  image::Mask not_thick(labels.size(), 1);
  each([&](const Piece& piece, int v, int u) {
    if (piece.half_px >= kThickShare * half_px &&
        static_cast<float>(piece.pixels) > kSmallArea * half_px * half_px) {
      not_thick.at(v, u) = 0;
    }
  });
  distance = image::distance_to_empty(not_thick);
  each([&](Piece& piece, int v, int u) {
    piece.beside += distance.at(v, u) <= 2 * piece.half_px + kGapPx ? 1 : 0;
  });
  return pieces;
}

// Thin, or short where there are many of them, and alongside the rope.
std::vector<std::uint8_t> pieces_to_keep(const std::vector<Piece>& pieces, float half_px) {
  std::vector<std::uint8_t> keep(pieces.size(), 1);
  keep.front() = 0;  // what is empty
  int thin = 0;
  for (const bool again : {false, true}) {
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      const auto area = static_cast<float>(pieces[i].pixels);
      if (static_cast<float>(pieces[i].beside) < kBesideShare * area) continue;
      const bool sliver = pieces[i].half_px <= kThinShare * half_px + 1e-3F;
      const bool crumb = again && thin >= kManySlivers && area <= kSmallArea * half_px * half_px;
      if (sliver || crumb) keep[i] = 0;
      thin += sliver && !again ? 1 : 0;
    }
  }
  return keep;
}

}  // namespace

bool erase_fringes(image::Mask& mask) {
  if (count_dark(mask) < kLeastDark) return false;
  image::Image<float> distance = image::distance_to_empty(mask);
  const float half_px = usual_half_px(distance);
  if (half_px < kLeastHalfPx) return false;
  // Lines may be diagonal.
  const auto [labels, found] = image::components(mask, image::Neighbours::kFour);
  const auto count = static_cast<int>(found.size());
  const std::vector<std::uint8_t> keep =
      pieces_to_keep(measure(labels, count, half_px, distance), half_px);
  if (std::all_of(keep.begin() + 1, keep.end(), [](std::uint8_t k) { return k != 0; }))
    return false;
  image::set_pieces(labels, keep, mask);
  return true;
}

}  // namespace flowdlo::path
