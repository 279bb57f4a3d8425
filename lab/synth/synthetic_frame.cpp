#include "synth/synthetic_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "synth/depth_sensor.hpp"
#include "synth/faults.hpp"
#include "synth/findings.hpp"
#include "synth/group.hpp"
#include "synth/look.hpp"
#include "synth/mask_segmenter.hpp"
#include "synth/rope.hpp"
#include "synth/thing.hpp"
#include "synth/tracer.hpp"
#include "synth/view.hpp"

namespace flowdlo::synth {
namespace {

constexpr int kAttempts = 400;          // of rope and view; one in a few succeeds
constexpr int kStagings = 6;            // of what stands around a rope
constexpr double kLeastVisible = 0.55;  // share of the rope that its occluders leave
constexpr int kLeastPixels = 120;       // of rope

// Everything before the first ray.
struct Stage {
  Rope rope;
  View view;
  Faults faults;
  std::vector<Thing> things;
};

std::string_view scenario_of(const SceneKey& key) {
  if (key.split == Split::kThesis) return thesis_group(key.part, key.index);
  Dice dice(key, Use::kScenario);
  return kWideScenarios[dice.pick({18, 13, 14, 11, 12, 8, 8, 9, 7})];
}

bool set_up_thesis(std::string_view scenario, Dice& ropes, Dice& views, Stage& stage) {
  auto rope = try_thesis_rope(scenario, ropes);
  if (!rope) return false;
  auto view = try_thesis_view(*rope, views);
  if (!view) return false;
  stage.rope = std::move(*rope);
  stage.view = std::move(*view);
  return true;
}

bool set_up_wide(std::string_view scenario, Dice& ropes, Dice& views, Stage& stage) {
  auto rope = try_wide_rope(scenario, ropes);
  if (!rope) return false;
  for (int k = 0; k < 3; ++k) {  // a rope is dear, a view is cheap
    if (auto view = try_wide_view(*rope, views)) {
      stage.rope = std::move(*rope);
      stage.view = std::move(*view);
      return true;
    }
  }
  return false;
}

void furnish(Stage& stage, Dice& dice) {
  stage.things.clear();
  if (stage.rope.hanging) add_grippers(stage.view, stage.rope, dice, stage.things);
  if (stage.faults.clutter) add_clutter(stage.view, stage.rope, dice, stage.things);
  if (stage.faults.bars) add_bars(stage.view, stage.rope.radius_m, dice, stage.things);
  if (stage.faults.hand) add_hand(stage.view, stage.rope.radius_m, dice, stage.things);
}

bool shows_enough(const Stage& stage, const Picture& picture) {
  const auto count = stage.view.curve.points.size();
  std::vector<bool> seen(count / 8 + 1, false);
  int pixels = 0;
  for (const Surface& surface : picture.surfaces) {
    if (surface.thing != kRopeThing) continue;
    ++pixels;
    seen[static_cast<std::size_t>(surface.along) / 8] = true;
  }
  const auto visible = std::count(seen.begin(), seen.end(), true);
  return pixels >= kLeastPixels &&
         static_cast<double>(visible) >= kLeastVisible * static_cast<double>(seen.size());
}

Result<void> check(Split split, Part part, std::uint64_t index, int frame) {
  const std::uint64_t count = split == Split::kThesis ? scene_count(split, part) : kMostScenes;
  std::string faults;
  if (index >= count) {
    faults = fmt::format("make_frame: index: expected below {} ({} {}), got {}", count,
                         name_of(split), name_of(part), index);
  }
  if (frame < 0) {
    faults += fmt::format("{}make_frame: render.frame: expected 0 or more, got {}",
                          faults.empty() ? "" : "\n", frame);
  }
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

Meta identity_of(const SceneKey& key, std::string_view scenario, int frame) {
  Meta meta;
  meta.scenario = scenario;
  meta.split = name_of(key.split);
  meta.part = name_of(key.part);
  meta.seed = key.seed;
  meta.index = key.index;
  meta.frame = frame;
  return meta;
}

void describe(const Stage& stage, const Material& material, Meta& meta) {
  meta.material = material.name;
  meta.band = material.band;
  meta.hanging = stage.rope.hanging;
  meta.square_ends = stage.rope.square_ends;
  meta.camera = stage.view.sensor->name;
  meta.distance_m = stage.view.distance_m;
  meta.tilt_deg = stage.view.tilt_rad * 180 / std::numbers::pi;
}

// A scene of a key: the rope, its view and things, and the ideal picture of it.
class Scene {
 public:
  Scene(const SceneKey& key, std::string_view scenario)
      : key_(key), look_(key, Use::kLook), scenario_(scenario) {}

  Result<void> set_up();
  [[nodiscard]] SyntheticFrame taken(const Render& render) const;

 private:
  Result<bool> stage_once(Dice& ropes, Dice& views, Dice& dice);

  SceneKey key_;
  Dice look_;
  const Material* material_ = nullptr;
  std::string_view scenario_;
  Stage stage_;
  std::optional<Tracer> tracer_;
  Picture picture_;
};

// True when this attempt shows enough of its rope.
Result<bool> Scene::stage_once(Dice& ropes, Dice& views, Dice& dice) {
  const bool wide = key_.split == Split::kWide;
  const bool ready = wide ? set_up_wide(scenario_, ropes, views, stage_)
                          : set_up_thesis(scenario_, ropes, views, stage_);
  if (!ready) return false;
  stage_.faults = {};
  if (wide) stage_.faults = draw_faults(stage_.rope, stage_.view, material_->dark, dice);
  for (int k = 0; k < kStagings; ++k) {
    furnish(stage_, dice);
    auto tracer = Tracer::create(stage_.view, stage_.rope, stage_.things);
    if (!tracer) return tracer.error();
    tracer_.emplace(std::move(*tracer));
    picture_ = tracer_->take_picture();
    if (shows_enough(stage_, picture_)) return true;
    if (stage_.things.empty()) return false;
  }
  return false;
}

Result<void> Scene::set_up() {
  material_ = &draw_material(look_);
  Dice ropes(key_, Use::kRope);
  Dice views(key_, Use::kView);
  Dice things(key_, Use::kThings);
  for (int k = 0; k < kAttempts; ++k) {
    const auto done = stage_once(ropes, views, things);
    if (!done) return done.error();
    if (*done) return {};
  }
  return Error{ErrorCode::kInternal,
               fmt::format("make_frame: no rope of scene {} fits its view in {} attempts",
                           key_.index, kAttempts)};
}

SyntheticFrame Scene::taken(const Render& render) const {
  Dice sensor(key_, Use::kSensor, render.frame);
  Dice mask(key_, Use::kMask, render.frame);
  const View& view = stage_.view;
  SyntheticFrame result;
  FrameFolder& folder = result.folder;
  result.meta = identity_of(key_, scenario_, render.frame);
  describe(stage_, *material_, result.meta);
  folder.name = folder_name(result.meta);
  folder.width = view.sensor->width;
  folder.height = view.sensor->height;
  folder.intrinsics = view.camera;
  folder.depth_m =
      measured_depth(view, picture_, stage_.rope.radius_m, stage_.faults.depth, sensor.word());
  folder.mask = segmented_mask(view, picture_, stage_.faults.mask, mask.word());
  folder.truth = nodes_of(view.curve);
  if (render.dense) {
    result.dense = {{view.curve}, stage_.rope.radius_m, picture_.depth_m, picture_.mask};
  }
  if (render.color) {
    Dice light(key_, Use::kLook, render.frame + 1);
    const auto windows = render.windows ? render.windows(result)
                                        : std::vector<Window>{{0, 0, folder.width, folder.height}};
    folder.color_bgr = colored(view, *tracer_, picture_, stage_.things, *material_,
                               stage_.rope.radius_m, key_.split == Split::kWide, windows, light);
  }
  find(view, stage_.rope, picture_, folder.depth_m, folder.mask, result.meta);
  note(stage_.faults, stage_.things, picture_, folder.depth_m, folder.mask, result.meta);
  return result;
}

}  // namespace

std::string folder_name(const Meta& meta) {
  const std::string scene = fmt::format("{:06}_{}", meta.index, meta.scenario);
  return meta.frame == 0 ? scene : fmt::format("{}_{:03}", scene, meta.frame);
}

Result<std::string_view> scenario_of(Split split, Part part, std::uint64_t seed,
                                     std::uint64_t index) {
  if (const auto good = check(split, part, index, 0); !good) return good.error();
  return scenario_of(SceneKey{split, part, seed, index});
}

Result<Meta> identity(Split split, Part part, std::uint64_t seed, std::uint64_t index, int frame) {
  if (const auto good = check(split, part, index, frame); !good) return good.error();
  const SceneKey key{split, part, seed, index};
  return identity_of(key, scenario_of(key), frame);
}

Result<SyntheticFrame> make_frame(Split split, Part part, std::uint64_t seed, std::uint64_t index,
                                  const Render& render) {
  if (const auto good = check(split, part, index, render.frame); !good) return good.error();
  const SceneKey key{split, part, seed, index};
  Scene scene(key, scenario_of(key));
  if (const auto ready = scene.set_up(); !ready) return ready.error();
  return scene.taken(render);
}

}  // namespace flowdlo::synth
