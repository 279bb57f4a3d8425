#include "synth/dice.hpp"

#include <cmath>
#include <numbers>

#include "random/philox.hpp"

namespace flowdlo::synth {
namespace {

constexpr int kBlockBits = 24;  // of the counter: 2^26 words a stream

}  // namespace

Dice::Dice(const SceneKey& key, Use use, int frame)
    : seed_(key.seed), stream_(stream_of(key, use, frame)), counter_(first_counter_of(key)) {}

std::uint64_t Dice::stream_of(const SceneKey& key, Use use, int frame) {
  constexpr std::uint64_t kSynth = 0x53;  // no other user of Philox takes these streams
  const auto split = static_cast<std::uint64_t>(key.split);
  return (kSynth << 56) | (static_cast<std::uint64_t>(frame) << 16) | ((split >> 1) << 8) |
         (static_cast<std::uint64_t>(use) << 2) | ((split & 1) << 1) |
         static_cast<std::uint64_t>(key.part);
}

std::uint64_t Dice::first_counter_of(const SceneKey& key) { return key.index << kBlockBits; }

std::uint32_t Dice::word() {
  if (used_ == 4) {
    words_ = random::philox(seed_, counter_++, stream_);
    used_ = 0;
  }
  return words_[static_cast<std::size_t>(used_++)];
}

double Dice::uniform(double low, double high) {
  return low + (high - low) * random::uniform(word());
}

double Dice::log_uniform(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

int Dice::integer(int low, int high) {
  const auto span = static_cast<std::uint64_t>(high - low + 1);
  return low + static_cast<int>((span * word()) >> 32);
}

double Dice::gaussian() {
  const double radius = std::sqrt(-2 * std::log(uniform(0, 1)));
  return radius * std::cos(2 * std::numbers::pi * uniform(0, 1));
}

bool Dice::chance(double probability) { return uniform(0, 1) < probability; }

std::size_t Dice::pick(std::initializer_list<double> weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  double left = uniform(0, sum);
  std::size_t index = 0;
  for (const double weight : weights) {
    if (left < weight) return index;
    left -= weight;
    ++index;
  }
  return weights.size() - 1;
}

}  // namespace flowdlo::synth
