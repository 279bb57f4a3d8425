// AlignedFloats: zeroed floats that begin at a cache line.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

namespace flowdlo::reference {

class AlignedFloats {
 public:
  AlignedFloats() = default;
  /// Throws std::bad_alloc. Pages that nobody writes to take no memory: buffers are as large as the
  /// largest frame, and most frames are smaller.
  explicit AlignedFloats(std::size_t count)
      : memory_(std::calloc(count * sizeof(float) + kAlignment, 1)), count_(count) {
    if (memory_ == nullptr) throw std::bad_alloc();
    void* begin = memory_.get();
    std::size_t space = count * sizeof(float) + kAlignment;
    floats_ = static_cast<float*>(std::align(kAlignment, count * sizeof(float), begin, space));
  }

  [[nodiscard]] float* data() const { return floats_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::span<float> span() const { return {floats_, count_}; }

 private:
  static constexpr std::size_t kAlignment = 64;
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  std::unique_ptr<void, Free> memory_;
  float* floats_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace flowdlo::reference
