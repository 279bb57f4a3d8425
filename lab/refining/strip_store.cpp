#include "refining/strip_store.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/refinement.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "field/network.hpp"
#include "files/whole_file.hpp"
#include "gate/calibrated.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "refine/local_frame.hpp"
#include "synth/evenly_spread.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/pool.hpp"
#include "threads/team.hpp"

namespace flowdlo::refining {
namespace {

constexpr std::uint64_t kMagic = 0x3130'5350'4952'5453;  // "STRIPS01"
constexpr std::size_t kStripFloats =
    static_cast<std::size_t>(refine::kStations) * weights::kRefineInputs;
static_assert(std::is_trivially_copyable_v<StripTruth>);

StripTruth truth_of(const Centerline& nodes, const Centerline& canonical) {
  const auto score = eval::score(nodes, canonical);
  const Centerline truth = eval::turned(canonical, score);
  StripTruth result;
  result.index_mm = static_cast<float>(1000 * score.either_index_m);
  const auto frames = refine::local_frames(nodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (!frames[i]) continue;
    const Eigen::Vector3f off = geometry::to_eigen(truth[i]) - geometry::to_eigen(nodes[i]);
    result.deep[i] = off.dot(frames[i]->deep);
    result.aside[i] = off.dot(frames[i]->aside);
    result.along[i] = off.dot(frames[i]->along);
  }
  return result;
}

/// Nothing where there is no path.
Result<std::optional<StripSample>> sample_of(const DataConfig& config, std::uint64_t number,
                                             field::Network* field) {
  const bool seen = field != nullptr && synth::evenly_spread(config.seen, number);
  const auto scene =
      synth::make_frame(synth::Split::kWide, synth::Part::kTraining, 0, config.first + number,
                        {.color = seen, .matched = synth::evenly_spread(config.matched, number)});
  if (!scene) return scene.error();
  const Frame frame = scene->frame();
  Timings timings;
  const auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) return std::optional<StripSample>();
  threads::Pool alone(1);
  const auto look = estimator::Rereading(alone, seen, field, *conditions, frame, {}).finish();
  const auto candidates =
      estimator::list_candidates(look, conditions->paths.rope_width_px, {}, {}, {}, frame, 0);
  const auto& chosen = candidates[gate::choose_calibrated(candidates).chosen];
  auto strip = refine::strip_along(estimator::curve_of(chosen), frame);
  if (!strip) return std::optional<StripSample>();
  StripSample sample{truth_of(chosen.nodes, eval::canonical(scene->truth())), *std::move(strip)};
  sample.truth.scene = scene->meta.index;
  sample.truth.matched = scene->meta.camera.ends_with("matched") ? 1.0F : 0.0F;
  sample.truth.radius_m = chosen.radius_m;
  for (auto* const offs : {&sample.truth.deep, &sample.truth.aside, &sample.truth.along}) {
    for (float& off : *offs) off /= chosen.radius_m;
  }
  return std::optional(std::move(sample));
}

std::filesystem::path shard_file(const std::filesystem::path& folder, std::uint64_t shard) {
  return folder / fmt::format("strips_{:05}.bin", shard);
}

template <class T>
std::span<const std::uint8_t> bytes_of(const T* values, std::size_t count) {
  return {reinterpret_cast<const std::uint8_t*>(values), count * sizeof(T)};
}

Result<void> make_shard(const std::filesystem::path& file, std::uint64_t shard,
                        const DataConfig& config, field::Network* field,
                        const std::function<void()>& progress) {
  std::vector<StripSample> samples;
  for (std::uint64_t i = 0; i < kShardScenes; ++i) {
    auto sample = sample_of(config, shard * kShardScenes + i, field);
    if (!sample) return sample.error();
    if (*sample) samples.push_back(**std::move(sample));
    progress();
  }
  const std::array<std::uint64_t, 2> head{kMagic, samples.size()};
  std::vector<std::span<const std::uint8_t>> parts{bytes_of(head.data(), head.size())};
  for (const StripSample& sample : samples) {
    parts.push_back(bytes_of(&sample.truth, 1));
    parts.push_back(bytes_of(sample.strip.values.data(), kStripFloats));
  }
  return files::write_file(file, parts, Durability::kUnsynced);
}

Error damaged(const std::filesystem::path& file) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: expected strips as flowdlo-train refine writes them; remove the file "
                      "and make it again",
                      file.string())};
}

Result<void> read_shard(const std::filesystem::path& file, std::vector<StripSample>& samples) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  std::array<std::uint64_t, 2> head{};
  if (bytes.size() < sizeof(head)) return damaged(file);
  std::memcpy(head.data(), bytes.data(), sizeof(head));
  constexpr std::size_t kSampleBytes = sizeof(StripTruth) + kStripFloats * sizeof(float);
  if (head[0] != kMagic || head[1] > kShardScenes ||
      bytes.size() != sizeof(head) + head[1] * kSampleBytes) {
    return damaged(file);
  }
  const char* at = bytes.data() + sizeof(head);
  for (std::uint64_t i = 0; i < head[1]; ++i, at += kSampleBytes) {
    StripSample sample;
    std::memcpy(&sample.truth, at, sizeof(StripTruth));
    sample.strip.values.resize(kStripFloats);
    std::memcpy(sample.strip.values.data(), at + sizeof(StripTruth), kStripFloats * sizeof(float));
    samples.push_back(std::move(sample));
  }
  return {};
}

}  // namespace

Result<void> make_strips(const std::filesystem::path& folder, const DataConfig& config,
                         std::shared_ptr<const weights::FieldWeights> field, int threads,
                         const std::function<void()>& progress) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a folder that can be made, got \"{}\"",
                                             folder.string(), failed.message())};
  }
  const std::uint64_t shards = (config.scenes + kShardScenes - 1) / kShardScenes;
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;
  Result<void> outcome;
  threads::work_together(threads, [&](int) {
    auto network = field::Network::create(field, [] { return reference::create_program(1); });
    const auto counted = [&] {
      const std::lock_guard lock(mutex);
      progress();
    };
    for (std::uint64_t shard = next++; shard < shards; shard = next++) {
      const auto file = shard_file(folder, shard);
      if (std::filesystem::exists(file)) {
        for (std::uint64_t i = 0; i < kShardScenes; ++i) counted();
        continue;
      }
      const Result<void> made = network ? make_shard(file, shard, config, &*network, counted)
                                        : Result<void>(network.error());
      if (made) continue;
      const std::lock_guard lock(mutex);
      outcome = made;
      next = shards;
    }
  });
  return outcome;
}

Result<std::vector<StripSample>> read_strips(const std::filesystem::path& folder) {
  std::vector<StripSample> samples;
  for (std::uint64_t shard = 0; std::filesystem::exists(shard_file(folder, shard)); ++shard) {
    if (auto read = read_shard(shard_file(folder, shard), samples); !read) return read.error();
  }
  if (!samples.empty()) return samples;
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected strips, got none; flowdlo-train refine makes them",
                           folder.string())};
}

}  // namespace flowdlo::refining
