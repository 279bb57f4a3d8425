// The two sub-iterations of Guo and Hall (CACM 1989), run over the border pixels only; each
// deletion is checked again when it is carried out, so that no stroke vanishes or breaks.
#include "path/thinning.hpp"

#include <array>
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
  explicit Thinner(const cv::Mat& mask)
      : image_(mask.clone()), queued_(static_cast<std::size_t>(mask.total()), 0) {
    const auto step = static_cast<int>(image_.step[0]);
    around_ = {-step, -step + 1, 1, step + 1, step, step - 1, -1, -step - 1};
    pixels_ = image_.ptr<std::uint8_t>();
  }

  cv::Mat run() {
    std::vector<int> active = borders();
    while (!active.empty()) {
      std::vector<int> touched;
      pass(active, kRules.first, touched);
      active.insert(active.end(), touched.begin(), touched.end());
      pass(active, kRules.second, touched);
      active.clear();
      for (const int p : touched) {
        if (queued_[p] != 0) {
          queued_[p] = 0;
          if (pixels_[p] != 0) active.push_back(p);
        }
      }
    }
    make_single();
    return image_;
  }

 private:
  [[nodiscard]] int code(int p) const {
    int bits = 0;
    for (int k = 0; k < 8; ++k) bits |= pixels_[p + around_[k]] << k;
    return bits;
  }

  [[nodiscard]] std::vector<int> borders() const {
    std::vector<int> list;
    const auto step = static_cast<int>(image_.step[0]);
    for (int v = 1; v + 1 < image_.rows; ++v) {
      for (int p = v * step + 1; p < v * step + image_.cols - 1; ++p) {
        if (pixels_[p] != 0 && code(p) != 255) list.push_back(p);
      }
    }
    return list;
  }

  // Deletes what `rule` allows among `active`; neighbours of the deleted go to `touched`, once.
  void pass(const std::vector<int>& active, const std::array<bool, 256>& rule,
            std::vector<int>& touched) {
    marked_.clear();
    for (const int p : active) {
      if (pixels_[p] != 0 && rule[code(p)]) marked_.push_back(p);
    }
    for (const int p : marked_) {
      if (pixels_[p] == 0 || !kRules.simple[code(p)]) continue;
      pixels_[p] = 0;
      for (const int offset : around_) {
        const int q = p + offset;
        if (pixels_[q] != 0 && queued_[q] == 0) {
          queued_[q] = 1;
          touched.push_back(q);
        }
      }
    }
  }

  // Staircases become diagonals: afterwards two neighbours mean a line, one a tip.
  void make_single() {
    const auto step = static_cast<int>(image_.step[0]);
    for (int v = 1; v + 1 < image_.rows; ++v) {
      for (int p = v * step + 1; p < v * step + image_.cols - 1; ++p) {
        if (pixels_[p] != 0 && kRules.corner[code(p)]) pixels_[p] = 0;
      }
    }
  }

  cv::Mat image_;
  std::vector<std::uint8_t> queued_;
  std::array<int, 8> around_{};
  std::uint8_t* pixels_ = nullptr;
  std::vector<int> marked_;
};

}  // namespace

cv::Mat thin(const cv::Mat& mask) { return Thinner(mask).run(); }

}  // namespace flowdlo::path
