// Runs of set pixels are joined with those of the row above that they touch.
#include "image/components.hpp"

#include <cstring>
#include <numeric>

namespace flowdlo::image {
namespace {

struct Run {
  int begin = 0;
  int end = 0;    // one behind the last pixel
  int piece = 0;  // the number of an earlier run of the same piece, or its own; at last the label
};

// The first pixel from `u` on that is set, or not.
int first_set(const std::uint8_t* row, int u, int width) {
  std::uint64_t eight = 0;
  while (u + 8 <= width) {
    std::memcpy(&eight, row + u, 8);
    if (eight != 0) break;
    u += 8;
  }
  while (u < width && row[u] == 0) ++u;
  return u;
}
int first_empty(const std::uint8_t* row, int u, int width) {
  while (u < width && row[u] != 0) ++u;
  return u;
}

class Labeller {
 public:
  Labeller(const Image<const std::uint8_t>& mask, Neighbours neighbours)
      : mask_(mask), reach_(neighbours == Neighbours::kEight ? 1 : 0) {}

  Components run() {
    find_runs();
    join();
    for (int i = 0; i < static_cast<int>(runs_.size()); ++i) run_at(i).piece = first_of(i);
    number();
    return drawn();
  }

 private:
  Run& run_at(int i) { return runs_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int begin_of(int v) const { return rows_[static_cast<std::size_t>(v)]; }

  void find_runs() {
    const int width = mask_.width();
    rows_.push_back(0);
    for (int v = 0; v < mask_.height(); ++v) {
      const std::uint8_t* const row = mask_.row(v);
      for (int u = first_set(row, 0, width); u < width; u = first_set(row, u, width)) {
        const int end = first_empty(row, u, width);
        runs_.push_back({u, end, static_cast<int>(runs_.size())});
        u = end;
      }
      rows_.push_back(static_cast<int>(runs_.size()));
    }
  }

  // The first run of the piece that a run belongs to, as far as it is known.
  int first_of(int i) {
    while (run_at(i).piece != i) {
      run_at(i).piece = run_at(run_at(i).piece).piece;
      i = run_at(i).piece;
    }
    return i;
  }

  void join() {
    for (int v = 1; v < mask_.height(); ++v) {
      int above = begin_of(v - 1);
      const int above_end = begin_of(v);
      for (int i = begin_of(v); i < begin_of(v + 1); ++i) {
        const Run run = run_at(i);
        while (above < above_end && run_at(above).end + reach_ <= run.begin) ++above;
        for (int k = above; k < above_end && run_at(k).begin < run.end + reach_; ++k) {
          const int a = first_of(k);
          const int b = first_of(i);
          run_at(std::max(a, b)).piece = std::min(a, b);
        }
      }
    }
  }

  // Labels instead of first runs.
  void number() {
    std::vector<int> label(runs_.size(), 0);
    const auto visit = [&](int i) {
      int& of_piece = label[static_cast<std::size_t>(run_at(i).piece)];
      if (of_piece == 0) of_piece = ++last_;
    };
    if (reach_ == 0) {
      for (int i = 0; i < static_cast<int>(runs_.size()); ++i) visit(i);
    } else {
      for (int v = 0; v < mask_.height(); v += 2) number_pair(v, visit);
    }
    for (Run& run : runs_) run.piece = label[static_cast<std::size_t>(run.piece)];
  }

  template <class Visit>
  void number_pair(int v, const Visit& visit) {
    int upper = begin_of(v);
    const int upper_end = begin_of(v + 1);
    int lower = upper_end;
    const int lower_end = v + 1 < mask_.height() ? begin_of(v + 2) : upper_end;
    while (upper < upper_end || lower < lower_end) {
      const bool from_upper =
          lower == lower_end ||
          (upper < upper_end && run_at(upper).begin / 2 <= run_at(lower).begin / 2);
      visit(from_upper ? upper++ : lower++);
    }
  }

  Components drawn() {
    Components result{Image<int>(mask_.size()), std::vector<Component>(1 + std::size_t(last_))};
    result.pieces[0].area = static_cast<int>(mask_.total());
    for (int v = 0; v < mask_.height(); ++v) {
      int* const to = result.labels.row(v);
      int u = 0;
      for (int i = begin_of(v); i < begin_of(v + 1); ++i) {
        const Run& run = run_at(i);
        std::fill(to + u, to + run.begin, 0);
        std::fill(to + run.begin, to + run.end, run.piece);
        u = run.end;
        add(run, v, result.pieces[static_cast<std::size_t>(run.piece)]);
        result.pieces[0].area -= run.end - run.begin;
      }
      std::fill(to + u, to + mask_.width(), 0);
    }
    return result;
  }

  static void add(const Run& run, int v, Component& piece) {
    Rect& box = piece.box;
    if (piece.area == 0) box = {run.begin, v, 0, 0};
    const int right = std::max(box.x + box.width, run.end);
    box.x = std::min(box.x, run.begin);
    box.width = right - box.x;
    box.height = v + 1 - box.y;
    piece.area += run.end - run.begin;
  }

  const Image<const std::uint8_t>& mask_;
  int reach_;
  std::vector<Run> runs_;
  std::vector<int> rows_;  // [height + 1] the number of each row's first run
  int last_ = 0;
};

}  // namespace

Components components(const Image<const std::uint8_t>& mask, Neighbours neighbours) {
  return Labeller(mask, neighbours).run();
}

void set_pieces(const Image<const int>& labels, const std::vector<std::uint8_t>& values,
                Mask& mask) {
  for (int v = 0; v < mask.height(); ++v) {
    const int* label = labels.row(v);
    std::uint8_t* row = mask.row(v);
    for (int u = 0; u < mask.width(); ++u) row[u] = values[static_cast<std::size_t>(label[u])];
  }
}

}  // namespace flowdlo::image
