#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace flowdlo::support {
namespace {

constexpr double kSilent_ms = 2000.0;
constexpr int kWidth = 30;

}  // namespace

ProgressBar::ProgressBar(std::string label, int total, bool quiet)
    : label_(std::move(label)), total_(total), enabled_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::advance() {
  ++done_;
  const std::chrono::duration<double, std::milli> elapsed = Clock::now() - start_;
  if (!enabled_ || elapsed.count() < kSilent_ms || total_ < 1) return;
  const int filled = kWidth * done_ / total_;
  const double left_s = elapsed.count() / 1000.0 / done_ * (total_ - done_);
  const auto bar = fmt::format("\r\x1b[K{} [{:#<{}}{:.<{}}] {}/{}, {:.0f} s left", label_, "",
                               filled, "", kWidth - filled, done_, total_, left_s);
  (void)std::fputs(bar.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  (void)std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace flowdlo::support
