#include "life.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "flowdlo/estimator.hpp"
#include "scene/scene.hpp"

namespace flowdlo::soak {
namespace {

constexpr int kKnownFrames = 6;
constexpr int kMostFrames = 8;  // of one life
constexpr int kSmallestSide_px = 64;
constexpr double kSmallestScale = 0.2;  // of a scene's own size
constexpr double kLargestScale = 1.2;
constexpr int kMostThreads = 4;
constexpr int kMostSteps = 4;
constexpr int kMostDraws = 3;

/// A scene at another size, by the nearest pixel.
struct ScaledFrame {
  int width = 0;
  int height = 0;
  Intrinsics camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;

  [[nodiscard]] Frame frame() const { return {width, height, camera, depth_m, mask, {}}; }
};

ScaledFrame scaled(const lab::Scene& scene, double scale) {
  const lab::Image& image = scene.image;
  ScaledFrame result;
  result.width = std::max(kSmallestSide_px, static_cast<int>(scale * image.width));
  result.height = std::max(kSmallestSide_px, static_cast<int>(scale * image.height));
  const auto along_u = static_cast<float>(result.width) / static_cast<float>(image.width);
  const auto along_v = static_cast<float>(result.height) / static_cast<float>(image.height);
  result.camera = {image.camera.fx * along_u, image.camera.fy * along_v, image.camera.cx * along_u,
                   image.camera.cy * along_v};
  for (int v = 0; v < result.height; ++v) {
    for (int u = 0; u < result.width; ++u) {
      const int from_u = u * image.width / result.width;
      const int from_v = v * image.height / result.height;
      const auto from = static_cast<std::size_t>(from_v * image.width + from_u);
      result.depth_m.push_back(image.depth_m[from]);
      result.mask.push_back(image.mask[from]);
    }
  }
  return result;
}

ScaledFrame known_frame(int index) {
  const auto kind = static_cast<lab::Kind>(index * 2 % lab::kKinds);
  return scaled(lab::make_scene(kind, static_cast<std::uint64_t>(index)), 0.3 + 0.1 * index);
}

ScaledFrame random_frame(std::mt19937_64& dice) {
  const auto kind = static_cast<lab::Kind>(dice() % lab::kKinds);
  const double share = static_cast<double>(dice() % 1000) / 1000;
  const double scale = kSmallestScale + share * (kLargestScale - kSmallestScale);
  ScaledFrame frame = scaled(lab::make_scene(kind, dice()), scale);
  const bool spoiled = dice() % 8 == 0;
  if (spoiled && dice() % 2 == 0) frame.mask.assign(frame.mask.size(), 0);  // no evidence
  if (spoiled && dice() % 2 == 0) frame.camera.fx = std::nanf("");          // no valid frame
  return frame;
}

// FNV-1a.
void mix(std::uint64_t& sum, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) sum = (sum ^ bytes[i]) * 0x100000001B3ULL;
}

std::uint64_t bits_of(const Result<Estimate>& estimate) {
  std::uint64_t sum = 0xCBF29CE484222325ULL;
  if (!estimate) {
    mix(sum, estimate.error().message.data(), estimate.error().message.size());
    return sum;
  }
  mix(sum, estimate->nodes.data(), sizeof(estimate->nodes));
  mix(sum, estimate->sigma_m.data(), sizeof(estimate->sigma_m));
  mix(sum, estimate->support.data(), sizeof(estimate->support));
  mix(sum, &estimate->confidence, sizeof(estimate->confidence));
  mix(sum, &estimate->draw, sizeof(estimate->draw));
  return sum;
}

Config random_config(const Place& place, const std::string& weights, std::mt19937_64& dice) {
  Config config;
  config.weights = weights;
  config.device = place.device;
  config.euler_steps = dice() % 4 == 0 ? kMostSteps : 1;
  config.draws = dice() % 4 == 0 ? kMostDraws : 1;
  config.threads = static_cast<int>(1 + dice() % kMostThreads);
  config.max_width = dice() % 2 == 0 ? 160 : 1280;  // smaller than some frames: memory grows later
  config.max_height = config.max_width * 3 / 4;
  return config;
}

}  // namespace

bool Memory::agrees(const std::string& device, int steps, int draws, int frame,
                    std::uint64_t bits) {
  const auto [entry, is_new] = first_.emplace(std::tuple(device, steps, draws, frame), bits);
  if (!is_new) ++comparisons_;
  return entry->second == bits;
}

Result<void> warm_up(const Place& place, const std::string& weights) {
  Config config;
  config.weights = weights;
  config.device = place.device;
  config.euler_steps = kMostSteps;
  config.draws = kMostDraws;
  config.threads = kMostThreads;
  auto estimator = Estimator::create(config);
  if (!estimator) return estimator.error();
  for (int kind = 0; kind < lab::kKinds; ++kind) {
    const auto largest = scaled(lab::make_scene(static_cast<lab::Kind>(kind), 1), kLargestScale);
    const auto estimate = estimator->estimate(largest.frame());
    if (!estimate && estimate.error().code == ErrorCode::kInternal) return estimate.error();
  }
  return {};
}

Result<void> live(const Place& place, const std::string& weights, std::mt19937_64& dice,
                  Memory& memory, Tally& tally) {
  const Config config = random_config(place, weights, dice);
  auto estimator = Estimator::create(config);
  if (!estimator) return estimator.error();
  const auto frames = static_cast<int>(1 + dice() % kMostFrames);
  for (int i = 0; i < frames; ++i) {
    const bool known = i == 0 || dice() % 3 == 0;
    const auto index = static_cast<int>(dice() % kKnownFrames);
    const ScaledFrame shown = known ? known_frame(index) : random_frame(dice);
    const auto estimate = estimator->estimate(shown.frame());
    ++tally.frames;
    if (!estimate) ++tally.refused;
    if (!estimate && estimate.error().code == ErrorCode::kInternal) return estimate.error();
    if (known &&
        !memory.agrees(place.name, config.euler_steps, config.draws, index, bits_of(estimate))) {
      return Error{
          ErrorCode::kInternal,
          fmt::format("{}: expected the same bits of frame {} as ever, got others ({} "
                      "steps, {} draws, {} threads)",
                      place.name, index, config.euler_steps, config.draws, config.threads)};
    }
  }
  return {};
}

}  // namespace flowdlo::soak
