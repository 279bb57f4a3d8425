// Values: one number a scene, and what tables say of them all.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace flowdlo::survey {

class Values {
 public:
  Values() = default;
  explicit Values(std::vector<double> all) : all_(std::move(all)) {}

  void add(double value) { all_.push_back(value); }
  void add(const Values& more) { all_.insert(all_.end(), more.all_.begin(), more.all_.end()); }

  [[nodiscard]] std::size_t count() const { return all_.size(); }
  [[nodiscard]] const std::vector<double>& all() const { return all_; }

  /// Each of what follows is 0 where there are no values.
  [[nodiscard]] double mean() const {
    double sum = 0;
    for (const double value : all_) sum += value;
    return all_.empty() ? 0 : sum / static_cast<double>(all_.size());
  }
  /// The value below which that share of them lies.
  [[nodiscard]] double quantile(double share) const {
    if (all_.empty()) return 0;
    auto sorted = all_;
    const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
    const auto wanted =
        sorted.begin() + static_cast<std::ptrdiff_t>(std::min(at, sorted.size() - 1));
    std::nth_element(sorted.begin(), wanted, sorted.end());
    return *wanted;
  }
  [[nodiscard]] double median() const { return quantile(0.5); }
  [[nodiscard]] double most() const { return quantile(1); }

  /// In percent.
  [[nodiscard]] double percent_over(double limit) const {
    const auto over =
        std::count_if(all_.begin(), all_.end(), [&](double value) { return value > limit; });
    return all_.empty() ? 0 : 100 * static_cast<double>(over) / static_cast<double>(all_.size());
  }

 private:
  std::vector<double> all_;
};

/// Of that many of so many; 0 of none.
[[nodiscard]] inline double percent(double part, double whole) {
  return whole > 0 ? 100 * part / whole : 0;
}

}  // namespace flowdlo::survey
