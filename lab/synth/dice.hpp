// Dice: the random numbers of one scene, one independent stream for each use.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {

/// Which scene; two different keys of one seed never share a random counter.
struct SceneKey {
  Split split = Split::kWide;
  Part part = Part::kTraining;
  std::uint64_t seed = 0;
  std::uint64_t index = 0;  ///< below kMostScenes
};

inline constexpr std::uint64_t kMostScenes = 1ULL << 40;

/// What the numbers are for: a change in one use leaves the others' numbers alone.
enum class Use : std::uint8_t {
  kScenario,
  kRope,
  kView,
  kThings,
  kSensor,
  kMask,
  kLook,
  kInfrared,
  kCord
};

class Dice {
 public:
  Dice(const SceneKey& key, Use use, int frame = 0);

  std::uint32_t word();
  /// In [low, high].
  double uniform(double low, double high);
  /// In [low, high], its logarithm uniform.
  double log_uniform(double low, double high);
  /// In low..high, both included.
  int integer(int low, int high);
  double gaussian();
  bool chance(double probability);
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  /// Below `count`; of one there is no choice, and no number is taken.
  std::size_t any_of(std::size_t count) {
    return count < 2 ? 0 : static_cast<std::size_t>(integer(0, static_cast<int>(count) - 1));
  }
  /// An index, in proportion to the weights.
  std::size_t pick(std::initializer_list<double> weights);

  /// The stream's counters: the part is a bit of the stream, the index a part of the counter.
  [[nodiscard]] static std::uint64_t stream_of(const SceneKey& key, Use use, int frame);
  [[nodiscard]] static std::uint64_t first_counter_of(const SceneKey& key);

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
};

}  // namespace flowdlo::synth
