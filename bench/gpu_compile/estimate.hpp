// Estimate: what a frame's dispatches would take on a card, by its compiler's own cost model.
#pragma once

#include <string>
#include <vector>

#include "gpu_compile/compiled_kernel.hpp"
#include "gpu_compile/frame_work.hpp"

namespace flowdlo::gpu_compile {

/// A card with two SIMDs of 32 lanes a compute unit (RDNA), each a multiply-add a cycle.
struct Card {
  std::string family;  ///< as RADV names it
  std::string name;
  int compute_units = 0;
  double clock_ghz = 0;   ///< boost
  int multiply_adds = 1;  ///< of a lane in a cycle: 2 where the compiler makes pairs of them
};

/// What its maker says: 80 units at 2.25 GHz (23.0 TFLOP/s) and 96 units at 2.5 GHz (61.4 TFLOP/s
/// with two instructions at once, of which ACO of Mesa 22.3 makes no use: 30.7).
[[nodiscard]] const std::vector<Card>& cards();

struct Share {
  int dispatches = 0;
  double flop = 0;           ///< multiply-adds count twice; 0 where nobody counts them
  double limit_ms = 0;       ///< every lane a multiply-add a cycle
  double full_ms = 0;        ///< the compiler's throughput, were there always plenty of subgroups
  double dispatched_ms = 0;  ///< with those that there are: none is shorter than one subgroup alone
};

struct FrameEstimate {
  Share dense;
  Share attention;
  Share convolution;
  Share visible_points;
  Share rest;

  [[nodiscard]] double full_ms() const;
  [[nodiscard]] double dispatched_ms() const;
};

/// Not in it: launching a dispatch and waiting for the one before, and memory beyond what the
/// compiler believes of it. `kernels` are those of `work`, in its order.
[[nodiscard]] FrameEstimate estimate(const FrameWork& work,
                                     const std::vector<CompiledKernel>& kernels, const Card& card);

/// Turns of a dispatch's loops, outermost first; empty where the compiler's guess has to do.
[[nodiscard]] std::vector<double> turns_of(const vulkan::KernelSpec& kernel,
                                           const vulkan::Dispatch& dispatch);

/// `cycles` as the compiler has them, with the loops' real turns in the place of its guess.
[[nodiscard]] double with_turns(double cycles, const std::vector<double>& instructions_by_depth,
                                const std::vector<double>& turns);

}  // namespace flowdlo::gpu_compile
