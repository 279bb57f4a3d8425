// Life: one estimator from its making to its end, and the frames that it sees in between.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::soak {

/// Where estimators run. `device` as Config::device has it.
struct Place {
  std::string device;
  std::string name;  ///< in the report
};

/// Frames that come again and again, on every device and with every number of threads: the same
/// frame, device, steps and draws must give the same bits for as long as the process lives.
class Memory {
 public:
  /// False where another life had other bits.
  [[nodiscard]] bool agrees(const std::string& device, int steps, int draws, int frame,
                            std::uint64_t bits);
  [[nodiscard]] long comparisons() const { return comparisons_; }

 private:
  std::map<std::tuple<std::string, int, int, int>, std::uint64_t> first_;
  long comparisons_ = 0;
};

struct Tally {
  long frames = 0;
  long refused = 0;  ///< frames that were answered with an Error
};

/// One estimator, and the largest frame of every kind: buffers, caches and drivers take what they
/// ever will.
[[nodiscard]] Result<void> warm_up(const Place& place, const std::string& weights);

/// Makes an estimator of a random kind, shows it random scenes of random sizes, some frames that
/// cannot be estimated and some that were seen before, and lets it go. The text of a failure is
/// what was promised and not kept.
[[nodiscard]] Result<void> live(const Place& place, const std::string& weights,
                                std::mt19937_64& dice, Memory& memory, Tally& tally);

}  // namespace flowdlo::soak
