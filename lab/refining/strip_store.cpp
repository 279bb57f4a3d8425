#include "refining/strip_store.hpp"

#include <optional>
#include <utility>

#include "estimator/candidates.hpp"
#include "estimator/conditions.hpp"
#include "estimator/refinement.hpp"
#include "estimator/second_look.hpp"
#include "eval/metrics.hpp"
#include "field/network.hpp"
#include "gate/fitted.hpp"
#include "geometry/camera.hpp"
#include "reference/program.hpp"
#include "refine/local_frame.hpp"
#include "refining/uneven.hpp"
#include "survey/shards.hpp"
#include "synth/evenly_spread.hpp"
#include "synth/synthetic_frame.hpp"
#include "threads/pool.hpp"

namespace flowdlo::refining {
namespace {

constexpr survey::ShardKind kStrips{0x3330'5350'4952'5453, "strips",  // "STRIPS03"
                                    "flowdlo-train refine", kShardScenes};
constexpr std::size_t kStripFloats =
    static_cast<std::size_t>(refine::kStations) * weights::kRefineInputs;

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

std::array<float, kNodes> ways_to_table(const refine::Curve& curve, const refine::Strip& strip) {
  std::array<float, kNodes> ways{};
  const auto frames = refine::local_frames(curve.nodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (!frames[i]) continue;
    ways[i] = (strip.table_share[i] - 1) * geometry::to_eigen(curve.nodes[i]).dot(frames[i]->deep) /
              curve.radius_m;
  }
  return ways;
}

/// What is chosen where nothing else is known: by the field's calibration, else the best score.
using Gate = std::optional<gate::GateWeights>;

/// Nothing where there is no path.
Result<std::optional<StripSample>> sample_of(const DataConfig& config, std::uint64_t number,
                                             field::Network* field, const Gate& gate) {
  const bool seen = field != nullptr && synth::evenly_spread(config.seen, number);
  auto scene =
      synth::make_frame(synth::Split::kWide, synth::Part::kTraining, 0, config.first + number,
                        {.color = seen, .matched = synth::evenly_spread(config.matched, number)});
  if (!scene) return scene.error();
  if (synth::evenly_spread(config.uneven, number)) make_uneven(number, *scene);
  const Frame frame = scene->frame();
  Timings timings;
  const auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) return std::optional<StripSample>();
  threads::Pool alone(1);
  const auto look = estimator::Rereading(alone, seen, field, *conditions, frame, {}).finish();
  const auto candidates =
      estimator::list_candidates(look, conditions->paths.rope_width_px, {}, {}, {}, frame, 0);
  const auto& chosen = candidates[gate ? gate::choose_calibrated(candidates, *gate).chosen : 0];
  const refine::Curve curve = estimator::curve_of(chosen);
  auto strip = refine::strip_along(curve, frame);
  if (!strip) return std::optional<StripSample>();
  StripSample sample{truth_of(chosen.nodes, eval::canonical(scene->truth())), *std::move(strip)};
  sample.to_table = ways_to_table(curve, sample.strip);
  sample.truth.scene = scene->meta.index;
  sample.truth.matched = scene->meta.camera.ends_with("matched") ? 1.0F : 0.0F;
  sample.truth.radius_m = chosen.radius_m;
  for (auto* const offs : {&sample.truth.deep, &sample.truth.aside, &sample.truth.along}) {
    for (float& off : *offs) off /= chosen.radius_m;
  }
  return std::optional(std::move(sample));
}

Result<std::vector<survey::Bytes>> packed_strips(const DataConfig& config, std::uint64_t number,
                                                 field::Network& field, const Gate& gate) {
  const auto sample = sample_of(config, number, &field, gate);
  if (!sample) return sample.error();
  std::vector<survey::Bytes> packed;
  if (*sample) {
    survey::Packer packer;
    packer.put((*sample)->truth);
    packer.put_all((*sample)->strip.values);
    packer.put((*sample)->to_table);
    packed.push_back(std::move(packer.bytes));
  }
  return packed;
}

}  // namespace

Result<void> make_strips(const std::filesystem::path& folder, const DataConfig& config,
                         std::shared_ptr<const weights::FieldWeights> field, int threads,
                         const std::function<void()>& progress) {
  Gate gate;
  if (field->calibration) gate = gate::gate_weights(*field->calibration);
  return survey::make_shards(
      folder, kStrips, config.scenes, threads,
      [&] { return field::Network::create(field, [] { return reference::create_program(1); }); },
      [&](field::Network& network, std::uint64_t scene) {
        return packed_strips(config, scene, network, gate);
      },
      progress);
}

Result<std::vector<StripSample>> read_strips(const std::filesystem::path& folder) {
  const auto store = survey::ShardStore::open(folder, kStrips);
  if (!store) return store.error();
  std::vector<StripSample> samples(store->size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto bytes = store->read(i);
    if (!bytes) return bytes.error();
    survey::Unpacker unpacker(*bytes);
    unpacker.get(samples[i].truth);
    unpacker.get_all(samples[i].strip.values);
    unpacker.get(samples[i].to_table);
    const bool whole = unpacker.fine() && samples[i].strip.values.size() == kStripFloats;
    if (!whole) return survey::damaged(store->file_of(i), kStrips);
  }
  return samples;
}

}  // namespace flowdlo::refining
