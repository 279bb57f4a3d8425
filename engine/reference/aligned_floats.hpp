// AlignedFloats: zeroed floats that begin at a cache line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>

namespace flowdlo::reference {

class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t count)
      : floats_(static_cast<float*>(::operator new(count * sizeof(float), kAlignment))),
        count_(count) {
    std::fill_n(floats_.get(), count, 0.0F);
  }

  [[nodiscard]] float* data() const { return floats_.get(); }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::span<float> span() const { return {floats_.get(), count_}; }

 private:
  static constexpr std::align_val_t kAlignment{64};
  struct Free {
    void operator()(float* floats) const { ::operator delete(floats, kAlignment); }
  };

  std::unique_ptr<float, Free> floats_;
  std::size_t count_ = 0;
};

}  // namespace flowdlo::reference
