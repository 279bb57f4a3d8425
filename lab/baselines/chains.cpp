#include "baselines/chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

namespace flowdlo::baselines {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

using Corners = std::array<cv::Point2d, 4>;
using Key = std::pair<std::pair<int, int>, std::pair<int, int>>;

double length(const Chain& chain) {
  double sum = 0;
  for (std::size_t i = 1; i < chain.size(); ++i) sum += cv::norm(chain[i] - chain[i - 1]);
  return sum;
}

void add_chains(const std::vector<cv::Point>& contour, const ChainConfig& config,
                std::vector<Chain>& chains) {
  const double least_cosine = std::cos(config.max_turn_deg * kDegree);
  std::optional<cv::Point> start;
  cv::Point2d last(0, 0);  // no direction yet
  Chain chain;
  const auto flush = [&] {
    if (!chain.empty()) chains.push_back(std::move(chain));
    chain = {};
    start.reset();
    last = {0, 0};
  };
  for (std::size_t i = 0; i + 1 < contour.size(); ++i) {  // the last vertex only flushes
    if (!start) start = contour[i];
    const cv::Point2d step = contour[i] - *start;
    if (cv::norm(step) <= config.segment_px) continue;
    if (last == cv::Point2d(0, 0)) {
      last = step;  // stored only: the segment's start stays
    } else if (step.dot(last) / (cv::norm(step) * cv::norm(last)) >= least_cosine) {
      if (chain.empty()) chain.push_back(*start);
      chain.push_back(contour[i]);
      start = contour[i];
      last = step;
    } else {
      flush();
    }
  }
  flush();
}

Key key_of(const cv::Point& a, const cv::Point& b) { return {{a.x, a.y}, {b.x, b.y}}; }

Corners rectangle(const cv::Point& a, const cv::Point& b, double width) {
  const double angle = std::atan2(b.y - a.y, b.x - a.x);
  const cv::Point2d aside(-width / 2 * std::sin(angle), width / 2 * std::cos(angle));
  const cv::Point2d p(a);
  const cv::Point2d q(b);
  return {p + aside, p - aside, q - aside, q + aside};
}

int side(const cv::Point2d& p, const cv::Point2d& q, const cv::Point2d& r) {
  const double cross = (q.y - p.y) * (r.x - q.x) - (q.x - p.x) * (r.y - q.y);
  return cross > 0 ? 1 : cross < 0 ? -1 : 0;
}

// Whether `q`, on the line through p and r, lies between them.
bool between(const cv::Point2d& p, const cv::Point2d& q, const cv::Point2d& r) {
  return q.x <= std::max(p.x, r.x) && q.x >= std::min(p.x, r.x) && q.y <= std::max(p.y, r.y) &&
         q.y >= std::min(p.y, r.y);
}

bool meet(const cv::Point2d& a, const cv::Point2d& b, const cv::Point2d& c, const cv::Point2d& d) {
  const int abc = side(a, b, c);
  const int abd = side(a, b, d);
  const int cda = side(c, d, a);
  const int cdb = side(c, d, b);
  if (abc != abd && cda != cdb) return true;
  return (abc == 0 && between(a, c, b)) || (abd == 0 && between(a, d, b)) ||
         (cda == 0 && between(c, a, d)) || (cdb == 0 && between(c, b, d));
}

bool cross(const Corners& one, const Corners& other) {  // borders only: one inside is no crossing
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (std::size_t j = 0; j < other.size(); ++j) {
      if (meet(one[i], one[(i + 1) % 4], other[j], other[(j + 1) % 4])) return true;
    }
  }
  return false;
}

class Pruner {
 public:
  Pruner(const std::vector<Chain>& chains, bool repaired, const ChainConfig& config)
      : repaired_(repaired), width_px_(config.segment_width_px) {
    for (const Chain& chain : chains) {
      for (std::size_t i = 1; i < chain.size(); ++i) {
        rectangles_.emplace(key_of(chain[i - 1], chain[i]),
                            rectangle(chain[i - 1], chain[i], width_px_));
      }
    }
  }

  // `chain` without the segments that cross one of `taken`.
  Chain rest(const Chain& chain, const Chain& taken) {
    Chain left;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Corners* own = rectangle_of(chain[i - 1], chain[i]);
      if (own == nullptr || crosses(*own, taken)) continue;
      if (left.empty()) left.push_back(chain[i - 1]);
      left.push_back(chain[i]);
    }
    return left;
  }

  [[nodiscard]] bool failed() const { return failed_; }

 private:
  bool crosses(const Corners& corners, const Chain& taken) {
    for (std::size_t k = 1; k < taken.size(); ++k) {
      const Corners* other = rectangle_of(taken[k - 1], taken[k]);
      if (other != nullptr && cross(*other, corners)) return true;
    }
    return false;
  }

  const Corners* rectangle_of(const cv::Point& a, const cv::Point& b) {
    auto found = rectangles_.find(key_of(a, b));
    if (found == rectangles_.end() && repaired_) {
      found = rectangles_.emplace(key_of(a, b), rectangle(a, b, width_px_)).first;
    }
    failed_ = failed_ || found == rectangles_.end();
    return found == rectangles_.end() ? nullptr : &found->second;
  }

  std::map<Key, Corners> rectangles_;
  bool repaired_;
  bool failed_ = false;
  double width_px_;
};

void sort_by_length(std::vector<Chain>& chains) {
  std::stable_sort(chains.begin(), chains.end(),
                   [](const Chain& a, const Chain& b) { return length(a) < length(b); });
}

}  // namespace

std::vector<Chain> chains_of(const cv::Mat& skeleton, const ChainConfig& config) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(skeleton.clone(), contours, cv::RETR_TREE, cv::CHAIN_APPROX_SIMPLE);
  std::vector<Chain> chains;
  for (const auto& contour : contours) add_chains(contour, config, chains);
  return chains;
}

Result<std::vector<Chain>> pruned(std::vector<Chain> chains, bool repaired,
                                  const ChainConfig& config) {
  Pruner pruner(chains, repaired, config);
  std::vector<Chain> kept;
  sort_by_length(chains);
  while (!chains.empty()) {
    Chain taken = std::move(chains.back());
    chains.pop_back();
    for (Chain& chain : chains) {
      chain = pruner.rest(chain, taken);
      if (pruner.failed()) return Error{ErrorCode::kInternal, "bridged segment has no rectangle"};
    }
    if (!taken.empty()) kept.push_back(std::move(taken));
    sort_by_length(chains);
  }
  return kept;
}

}  // namespace flowdlo::baselines
