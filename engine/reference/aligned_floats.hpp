// AlignedFloats and AlignedHalves: zeroed values that begin at a cache line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

namespace flowdlo::reference {

template <class Value>
class AlignedValues {
 public:
  AlignedValues() = default;
  /// Throws std::bad_alloc. Pages that nobody writes to take no memory: buffers are as large as the
  /// largest frame, and most frames are smaller.
  explicit AlignedValues(std::size_t count)
      : memory_(std::calloc(count * sizeof(Value) + kAlignment, 1)), count_(count) {
    if (memory_ == nullptr) throw std::bad_alloc();
    void* begin = memory_.get();
    std::size_t space = count * sizeof(Value) + kAlignment;
    values_ = static_cast<Value*>(std::align(kAlignment, count * sizeof(Value), begin, space));
  }

  [[nodiscard]] Value* data() const { return values_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::span<Value> span() const { return {values_, count_}; }

 private:
  static constexpr std::size_t kAlignment = 64;
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  std::unique_ptr<void, Free> memory_;
  Value* values_ = nullptr;
  std::size_t count_ = 0;
};

using AlignedFloats = AlignedValues<float>;
using AlignedHalves = AlignedValues<std::uint16_t>;  // IEEE 754 binary16

}  // namespace flowdlo::reference
