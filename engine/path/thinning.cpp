// The two sub-iterations of Guo and Hall (CACM 1989), run over the border pixels only; each
// deletion is checked again when it is carried out, so that no stroke vanishes or breaks.
#include "path/thinning.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flowdlo::path {
namespace {

// Neighbours clockwise from north: bit k is neighbour k.
struct Rules {
  std::array<bool, 256> first{};   // deletable in the first sub-iteration
  std::array<bool, 256> second{};  // in the second
  std::array<bool, 256> simple{};  // deletion keeps the topology
  std::array<bool, 256> corner{};  // of a staircase: deletion leaves a diagonal
};

constexpr Rules make_rules() {
  Rules rules;
  for (int code = 0; code < 256; ++code) {
    std::array<int, 8> x{};
    for (int k = 0; k < 8; ++k) x[k] = (code >> k) & 1;
    int groups = 0;        // runs of neighbours around
    int connectivity = 0;  // Yokoi's number for 8-connected objects
    int pairs_a = 0;       // neighbours, counted in pairs, both ways to pair them
    int pairs_b = 0;
    for (int k = 0; k < 8; k += 2) {
      const int next = x[(k + 1) % 8];
      const int over = x[(k + 2) % 8];
      groups += x[k] == 0 && (next == 1 || over == 1) ? 1 : 0;
      connectivity += (1 - x[k]) - (1 - x[k]) * (1 - next) * (1 - over);
      pairs_a += x[k] | next;
      pairs_b += next | over;
    }
    const int pairs = pairs_a < pairs_b ? pairs_a : pairs_b;
    const bool border = groups == 1 && pairs >= 2 && pairs <= 3;
    rules.first[code] = border && ((x[0] | x[1] | (1 - x[3])) & x[2]) == 0;
    rules.second[code] = border && ((x[4] | x[5] | (1 - x[7])) & x[6]) == 0;
    rules.simple[code] = connectivity == 1;
    for (int k = 0; k < 8; k += 2) {
      const bool turn = x[k] == 1 && x[(k + 2) % 8] == 1;
      rules.corner[code] = rules.corner[code] || (turn && connectivity == 1);
    }
  }
  return rules;
}

constexpr Rules kRules = make_rules();

class Thinner {
 public:
  explicit Thinner(const image::Mask& mask)
      : image_(mask.clone()), step_(static_cast<int>(image_.stride())), queued_(mask.total(), 0) {}

  image::Mask run() {
    std::vector<int> active = borders();
    std::vector<int> touched;
    while (!active.empty()) {
      touched.clear();
      pass(active, kRules.first, touched);
      active.insert(active.end(), touched.begin(), touched.end());
      pass(active, kRules.second, touched);
      active.clear();
      const std::uint8_t* const pixels = image_.data();
      for (const int p : touched) {
        queued_[p] = 0;
        if (pixels[p] != 0) active.push_back(p);
      }
    }
    make_single();
    return image_;
  }

 private:
  // The neighbours of `at` as bits.
  [[nodiscard]] static int code(const std::uint8_t* at, std::ptrdiff_t step) {
    const std::uint8_t* const up = at - step;
    const std::uint8_t* const down = at + step;
    return up[0] | up[1] << 1 | at[1] << 2 | down[1] << 3 | down[0] << 4 | down[-1] << 5 |
           at[-1] << 6 | up[-1] << 7;
  }

  [[nodiscard]] std::vector<int> borders() const {
    std::vector<int> list;
    const std::uint8_t* const pixels = image_.data();
    for (int v = 1; v + 1 < image_.height(); ++v) {
      for (int p = v * step_ + 1; p < v * step_ + image_.width() - 1; ++p) {
        if (pixels[p] != 0 && code(pixels + p, step_) != 255) list.push_back(p);
      }
    }
    return list;
  }

  // Deletes what `rule` allows among `active`; neighbours of the deleted go to `touched`, once.
  // Which pixels go is as good as random to a branch predictor: lists grow without branches.
  void pass(const std::vector<int>& active, const std::array<bool, 256>& rule,
            std::vector<int>& touched) {
    std::uint8_t* const pixels = image_.data();
    std::uint8_t* const queued = queued_.data();
    const std::ptrdiff_t step = step_;
    const std::array<std::ptrdiff_t, 8> around{-step, -step + 1, 1,  step + 1,
                                               step,  step - 1,  -1, -step - 1};
    marked_.resize(std::max(marked_.size(), active.size()));
    std::size_t marked = 0;
    for (const int p : active) {
      marked_[marked] = p;
      marked += pixels[p] & rule[static_cast<std::size_t>(code(pixels + p, step))] ? 1 : 0;
    }
    std::size_t count = touched.size();
    for (std::size_t i = 0; i < marked; ++i) {
      const int p = marked_[i];
      if (pixels[p] == 0 || !kRules.simple[static_cast<std::size_t>(code(pixels + p, step))]) {
        continue;
      }
      pixels[p] = 0;
      if (touched.size() < count + around.size()) touched.resize(2 * (count + around.size()));
      for (const std::ptrdiff_t offset : around) {
        const std::ptrdiff_t q = p + offset;
        const int added = pixels[q] & (queued[q] ^ 1);
        queued[q] |= pixels[q];
        touched[count] = static_cast<int>(q);
        count += static_cast<std::size_t>(added);
      }
    }
    touched.resize(count);
  }

  // Staircases become diagonals: afterwards two neighbours mean a line, one a tip.
  void make_single() {
    std::uint8_t* const pixels = image_.data();
    for (int v = 1; v + 1 < image_.height(); ++v) {
      for (int p = v * step_ + 1; p < v * step_ + image_.width() - 1; ++p) {
        if (pixels[p] == 0) continue;
        if (kRules.corner[static_cast<std::size_t>(code(pixels + p, step_))]) pixels[p] = 0;
      }
    }
  }

  image::Mask image_;
  int step_;
  std::vector<std::uint8_t> queued_;  // by pixel: 1 where it is in `touched`
  std::vector<int> marked_;
};

}  // namespace

image::Mask thin(const image::Mask& mask) { return Thinner(mask).run(); }

}  // namespace flowdlo::path
