#include "growth.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flowdlo::soak {
namespace {

constexpr std::size_t kFewestLives = 8;  // two in a quarter

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Level Growth::level(std::size_t begin, std::size_t end) const {
  std::vector<double> resident;
  std::vector<double> heap;
  std::vector<double> descriptors;
  std::vector<double> threads;
  for (std::size_t i = begin; i < end; ++i) {
    resident.push_back(lives_[i].resident_mb);
    heap.push_back(lives_[i].heap_mb);
    descriptors.push_back(lives_[i].descriptors);
    threads.push_back(lives_[i].threads);
  }
  return {median(resident), median(heap), median(descriptors), median(threads)};
}

Level Growth::early() const { return level(lives_.size() / 4, lives_.size() / 2); }

Level Growth::late() const { return level(lives_.size() - lives_.size() / 4, lives_.size()); }

std::vector<std::string> Growth::faults(const Allowance& allowance) const {
  std::vector<std::string> found;
  if (lives_.size() < kFewestLives) return found;
  const auto check = [&](const char* what, double before, double after, double allowed) {
    if (after - before <= allowed) return;
    found.push_back(
        fmt::format("{}: expected at most {} more in the last quarter of {} lives than "
                    "in the second, got {:.1f} after {:.1f}",
                    what, allowed, lives_.size(), after, before));
  };
  const Level before = early();
  const Level after = late();
  check("resident MB", before.resident_mb, after.resident_mb, allowance.resident_mb);
  const double lives = 0.5 * static_cast<double>(lives_.size());
  check("heap MB", before.heap_mb, after.heap_mb,
        allowance.heap_mb + lives * allowance.heap_mb_a_life);
  check("open files", before.descriptors, after.descriptors, allowance.descriptors);
  check("threads", before.threads, after.threads, allowance.threads);
  return found;
}

}  // namespace flowdlo::soak
