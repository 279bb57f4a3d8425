// Checks: what each way to a mask needs of a frame and of its arguments, every fault at once.
#pragma once

#include <string>

#include "flowdlo/frame.hpp"
#include "flowdlo/mask.hpp"
#include "frame/faults.hpp"

namespace flowdlo::mask {

/// Faults of one call, which `who` begins.
class Checks {
 public:
  explicit Checks(const char* who) : who_(who) {}

  void size(int width, int height);
  void color(const Frame& frame);                 ///< there, and of the frame's size
  void depth(const Frame& frame);                 ///< the same
  void intrinsics(const Intrinsics& intrinsics);  ///< usable
  void cleaning(const MaskCleaning& cleaning);

  /// `value` in [least, most]; finite in any case.
  void within(const char* name, float value, float least, float most);
  /// `value` over 0 and at most `most`.
  void positive(const char* name, float value, float most);
  void fault(const std::string& what);

  [[nodiscard]] Result<void> outcome() const;

 private:
  void count(const char* name, std::size_t values, const Frame& frame, int channels,
             const char* remedy);

  const char* who_;
  frame::Faults faults_;
};

}  // namespace flowdlo::mask
