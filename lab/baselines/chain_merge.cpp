#include "baselines/chain_merge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "track/cheapest_assignment.hpp"

namespace flowdlo::baselines {
namespace {

constexpr double kDistanceWeight = 0.001;  // of a pixel, against a radian
constexpr double kSameChain = 100000;
constexpr double kRopeEnd = 1000;

struct Tip {
  cv::Point2d at;
  cv::Point2d inner;  // the point before it on its chain
};

Tip tip_of(const Chain& chain, bool end) {
  if (end) return {chain.back(), chain[chain.size() - 2]};
  return {chain.front(), chain[1]};
}

double angle(const cv::Point2d& a, const cv::Point2d& b, bool repaired) {
  // Divided as the original does: the quotient may exceed 1 by rounding, and be 0 / 0.
  const double cosine = a.dot(b) / (cv::norm(b) * cv::norm(a));
  if (!repaired) return std::abs(std::acos(cosine));
  return std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.0, 1.0)) : 0;
}

// The rope leaves the first chain at `from` and goes on at `to`.
double cost_of(const Tip& from, const Tip& to, bool repaired) {
  const cv::Point2d link = to.at - from.at;
  const double turns =
      angle(link, from.at - from.inner, repaired) + angle(link, to.inner - to.at, repaired);
  return kDistanceWeight * cv::norm(link) + turns / 2;
}

std::vector<std::vector<double>> costs(const std::vector<Chain>& chains, bool repaired) {
  const std::size_t tips = 2 * chains.size();
  std::vector<std::vector<double>> cost(tips + 2, std::vector<double>(tips + 2, kRopeEnd));
  for (std::size_t a = 0; a < tips; ++a) {
    for (std::size_t b = 0; b < tips; ++b) {
      const Tip from = tip_of(chains[a / 2], a % 2 == 1);
      const Tip to = tip_of(chains[b / 2], b % 2 == 1);
      cost[a][b] = a / 2 == b / 2 ? kSameChain : cost_of(from, to, repaired);
    }
  }
  for (std::size_t a = tips; a < tips + 2; ++a) {
    for (std::size_t b = tips; b < tips + 2; ++b) cost[a][b] = kSameChain;
  }
  return cost;
}

// From the partner of the last rope end along the partners to a rope end. A chain may come twice,
// as the assignment need not be symmetric; turning it then turns both.
Chain walk(const std::vector<Chain>& chains, const std::vector<int>& partner) {
  const int tips = static_cast<int>(2 * chains.size());
  std::vector<std::size_t> order;
  std::vector<char> turned(chains.size(), 0);
  int tip = partner.back();
  while (tip < tips && order.size() < 2 * chains.size()) {
    const auto chain = static_cast<std::size_t>(tip / 2);
    if (tip % 2 == 1) turned[chain] = turned[chain] == 0 ? 1 : 0;
    order.push_back(chain);
    tip = partner[static_cast<std::size_t>(tip % 2 == 0 ? tip + 1 : tip - 1)];
  }
  Chain points;
  for (const std::size_t chain : order) {
    Chain piece = chains[chain];
    if (turned[chain] != 0) std::reverse(piece.begin(), piece.end());
    points.insert(points.end(), piece.begin(), piece.end());
  }
  return points;
}

}  // namespace

Result<Chain> merged(const std::vector<Chain>& chains, bool repaired) {
  if (chains.empty()) return Error{ErrorCode::kNoPath, "no chain on the skeleton"};
  if (chains.size() == 1) return chains.front();
  const auto cost = costs(chains, repaired);
  for (const auto& row : cost) {
    if (!std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); })) {
      return Error{ErrorCode::kInternal, "cost of two tips is not a number"};
    }
  }
  return walk(chains, track::cheapest_assignment(cost));
}

}  // namespace flowdlo::baselines
