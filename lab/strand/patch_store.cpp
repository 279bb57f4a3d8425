#include "strand/patch_store.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include "synth/evenly_spread.hpp"

namespace flowdlo::strand {
namespace {

constexpr survey::ShardKind kPatches{0x31304843544150ULL, "patches",  // "PATCH01"
                                     "flowdlo-train field-patches", kShardScenes};

void put(const Patch& patch, survey::Packer& to) {
  to.put(patch.width);
  to.put(patch.height);
  to.put(patch.frame_scale);
  to.put(patch.focal_px);
  to.put(patch.rope_px);
  to.put_all(patch.color_bgr);
  to.put_all(patch.mask);
  to.put_all(patch.depth);
  to.put(static_cast<std::uint64_t>(patch.strands.size()));
  for (const Strand& strand : patch.strands) {
    to.put(strand.rope);
    to.put_all(strand.points);
    to.put(strand.begins);
    to.put(strand.ends);
  }
}

std::optional<Patch> get(survey::Unpacker& from) {
  Patch patch;
  from.get(patch.width);
  from.get(patch.height);
  from.get(patch.frame_scale);
  from.get(patch.focal_px);
  from.get(patch.rope_px);
  from.get_all(patch.color_bgr);
  from.get_all(patch.mask);
  from.get_all(patch.depth);
  std::uint64_t strands = 0;
  from.get(strands);
  for (std::uint64_t i = 0; i < strands && from.fine(); ++i) {
    Strand strand;
    from.get(strand.rope);
    from.get_all(strand.points);
    from.get(strand.begins);
    from.get(strand.ends);
    patch.strands.push_back(std::move(strand));
  }
  const auto pixels =
      static_cast<std::size_t>(patch.width) * static_cast<std::size_t>(patch.height);
  const bool whole = from.fine() && patch.width > 0 && patch.height > 0 &&
                     patch.mask.size() == pixels && patch.depth.size() == pixels &&
                     patch.color_bgr.size() == 3 * pixels;
  return whole ? std::optional(std::move(patch)) : std::nullopt;
}

constexpr std::string_view kTouching = "ends-touch";

/// The first scene whose ring has ends that touch, of as many as `scene` has for itself: one in
/// twelve is such a ring.
std::uint64_t touching_index(std::uint64_t seed, std::uint64_t scene) {
  constexpr std::uint64_t kForEach = 256;
  const auto touches = [&](std::uint64_t index) {
    const auto scenario =
        synth::scenario_of(synth::Split::kWide, synth::Part::kTraining, seed, index);
    return scenario && *scenario == kTouching;
  };
  std::uint64_t index = kForEach * scene;
  while (!touches(index) && index + 1 < kForEach * (scene + 1)) ++index;
  return index;
}

Result<std::vector<Patch>> patches_of(const DataConfig& config, std::uint64_t scene) {
  if (synth::evenly_spread(config.drawn, scene)) {
    return drawn_patches_of(config.seed, scene, config.patch);
  }
  synth::Render as;
  as.cords = synth::evenly_spread(config.cords, scene);
  if (synth::evenly_spread(config.touching, scene)) {
    const std::uint64_t seed = config.seed + 1;  // other scenes than the rest
    return patches_of(synth::Split::kWide, synth::Part::kTraining, seed,
                      touching_index(seed, scene), config.patch, as);
  }
  as.matched = synth::evenly_spread(config.matched, scene);
  const auto split = synth::evenly_spread(config.tangled, scene)   ? synth::Split::kTangled
                     : synth::evenly_spread(config.several, scene) ? synth::Split::kSeveral
                                                                   : synth::Split::kWide;
  return patches_of(split, synth::Part::kTraining, config.seed, scene, config.patch, as);
}

Result<std::vector<survey::Bytes>> packed_patches(const DataConfig& config, std::uint64_t scene) {
  const auto patches = patches_of(config, scene);
  if (!patches) return patches.error();
  std::vector<survey::Bytes> packed;
  for (const Patch& patch : *patches) {
    survey::Packer packer;
    put(patch, packer);
    packed.push_back(std::move(packer.bytes));
  }
  return packed;
}

}  // namespace

Result<void> make_patches(const std::filesystem::path& folder, const DataConfig& config,
                          int threads, const std::function<void()>& progress) {
  return survey::make_shards(
      folder, kPatches, config.scenes, threads, survey::no_tool,
      [&](survey::Nothing, std::uint64_t scene) { return packed_patches(config, scene); },
      progress);
}

Result<PatchStore> PatchStore::open(const std::filesystem::path& folder) {
  auto store = survey::ShardStore::open(folder, kPatches);
  if (!store) return store.error();
  return PatchStore(*std::move(store));
}

Result<Patch> PatchStore::read(std::size_t index) const {
  const auto bytes = store_.read(index);
  if (!bytes) return bytes.error();
  survey::Unpacker unpacker(*bytes);
  auto patch = get(unpacker);
  if (!patch) return survey::damaged(store_.file_of(index), kPatches);
  return *std::move(patch);
}

}  // namespace flowdlo::strand
