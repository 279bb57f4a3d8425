#include "synth/synthetic_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "synth/depth_sensor.hpp"
#include "synth/drawn_frame.hpp"
#include "synth/faults.hpp"
#include "synth/findings.hpp"
#include "synth/group.hpp"
#include "synth/look.hpp"
#include "synth/mask_segmenter.hpp"
#include "synth/rope.hpp"
#include "synth/stereo_pair.hpp"
#include "synth/thing.hpp"
#include "synth/tracer.hpp"
#include "synth/view.hpp"

namespace flowdlo::synth {
namespace {

constexpr int kAttempts = 400;           // of rope and view; one in a few succeeds
constexpr int kStagings = 6;             // of what stands around a rope
constexpr double kLeastVisible = 0.55;   // share of the rope that its occluders leave
constexpr double kLeastOfSeveral = 0.3;  // share of each, of several that may leave the image
constexpr int kLeastPixels = 120;        // of rope
constexpr HsvBand kAnyColor = {{0, 0, 0}, {180, 255, 255}};

// Everything before the first ray.
struct Stage {
  bool cords = false;       // as Render has it
  bool ring_alone = false;  // likewise
  Ropes ropes;
  View view;
  Faults faults;
  std::vector<Thing> things;
};

std::string_view scenario_of(const SceneKey& key) {
  if (key.split == Split::kThesis) return thesis_group(key.part, key.index);
  if (key.split == Split::kDrawn) return lab::kind_names()[key.index % lab::kKinds];
  Dice dice(key, Use::kScenario);
  if (key.split == Split::kSeveral) return kSeveralScenarios[dice.pick({30, 20, 20, 15, 15})];
  if (key.split == Split::kTangled) return kTangledScenarios[dice.pick({35, 20, 20, 25})];
  return kWideScenarios[dice.pick({18, 13, 14, 11, 12, 8, 8, 9, 7})];
}

bool set_up_thesis(std::string_view scenario, Dice& ropes, Dice& views, Stage& stage) {
  auto rope = try_thesis_rope(scenario, ropes);
  if (!rope) return false;
  auto view = try_thesis_view({&*rope, 1}, views);
  if (!view) return false;
  stage.ropes = {std::move(*rope)};
  stage.view = std::move(*view);
  return true;
}

// Ropes are dear, a view is cheap.
template <class TryView>
bool set_up_view(Ropes ropes, TryView try_view, Dice& views, Stage& stage) {
  for (int k = 0; k < 3; ++k) {
    if (auto view = try_view(ropes, views)) {
      stage.ropes = std::move(ropes);
      stage.view = std::move(*view);
      return true;
    }
  }
  return false;
}

bool set_up_wide(std::string_view scenario, Dice& ropes, Dice& views, Stage& stage) {
  auto rope = try_wide_rope(scenario, ropes);
  return rope && set_up_view({std::move(*rope)}, try_wide_view, views, stage);
}

bool set_up_several(std::string_view scenario, Dice& dice, Dice& views, Stage& stage) {
  const bool tangled = scenario.starts_with("tangled");
  auto ropes = tangled ? try_tangled_ropes(scenario, dice) : try_several_ropes(scenario, dice);
  if (!ropes) return false;
  if (stage.ring_alone) std::erase_if(*ropes, [](const Rope& rope) { return !rope.closed; });
  if (ropes->empty()) return false;
  const bool near = scenario == "ropes-leaving" || scenario == "tangled-near";
  return set_up_view(*std::move(ropes), near ? try_near_view : try_wide_view, views, stage);
}

// Half of all sets are ropes of one kind, as a workshop has them.
void draw_cords(Dice dice, Ropes& ropes) {
  const Cord all = draw_cord(dice);
  const bool alike = dice.chance(0.5);
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    ropes[k].cord = k == 0 || alike ? all : draw_cord(dice);
  }
}

void furnish(Stage& stage, Dice& dice) {
  stage.things.clear();
  double radius_m = 0;
  for (std::size_t k = 0; k < stage.ropes.size(); ++k) {
    const Rope& rope = stage.ropes[k];
    radius_m = std::max(radius_m, rope.radius_m);
    if (rope.hanging) add_grippers(stage.view, rope, stage.view.curves[k], dice, stage.things);
  }
  const bool hanging = stage.ropes.front().hanging;
  if (stage.faults.clutter) add_clutter(stage.view, radius_m, hanging, dice, stage.things);
  if (stage.faults.bars) add_bars(stage.view, radius_m, dice, stage.things);
  if (stage.faults.hand) add_hand(stage.view, radius_m, dice, stage.things);
}

// Of each rope, in shares of its length and in pixels.
bool shows_enough(const Stage& stage, const Picture& picture) {
  const std::size_t ropes = stage.ropes.size();
  std::vector<std::vector<bool>> seen;
  for (const Curve& curve : stage.view.curves) seen.emplace_back(curve.points.size() / 8 + 1);
  std::vector<int> pixels(ropes, 0);
  for (const Surface& surface : picture.surfaces) {
    if (surface.thing != kRopeThing) continue;
    ++pixels[surface.rope];
    seen[surface.rope][static_cast<std::size_t>(surface.along) / 8] = true;
  }
  const double least = ropes == 1 ? kLeastVisible : kLeastOfSeveral;
  for (std::size_t k = 0; k < ropes; ++k) {
    const auto visible = std::count(seen[k].begin(), seen[k].end(), true);
    if (pixels[k] < kLeastPixels ||
        static_cast<double>(visible) < least * static_cast<double>(seen[k].size())) {
      return false;
    }
  }
  return true;
}

std::uint64_t most_scenes(Split split, Part part) {
  if (split == Split::kThesis) return scene_count(split, part);
  const bool ends = split == Split::kDrawn && part == Part::kTraining;
  return ends ? kFirstDrawnValidation * lab::kKinds : kMostScenes;
}

Result<void> check(Split split, Part part, std::uint64_t index, int frame) {
  const std::uint64_t count = most_scenes(split, part);
  std::string faults;
  if (index >= count) {
    faults = fmt::format("make_frame: index: expected below {} ({} {}), got {}", count,
                         name_of(split), name_of(part), index);
  }
  if (frame < 0 || (split == Split::kDrawn && frame > 0)) {
    faults +=
        fmt::format("{}make_frame: render.frame: expected {}, got {}", faults.empty() ? "" : "\n",
                    split == Split::kDrawn ? "0 of a drawn scene" : "0 or more", frame);
  }
  if (faults.empty()) return {};
  return Error{ErrorCode::kBadInput, faults};
}

Meta identity_of(const SceneKey& key, std::string_view scenario, const Render& render) {
  Meta meta;
  meta.scenario = scenario;
  meta.split = name_of(key.split);
  meta.part = name_of(key.part);
  meta.seed = key.seed;
  meta.index = key.index;
  meta.frame = render.frame;
  meta.cords = render.cords;
  meta.matched = render.matched;
  return meta;
}

SyntheticFrame drawn(const SceneKey& key, const Render& render) {
  const auto kind = static_cast<lab::Kind>(key.index % lab::kKinds);
  SyntheticFrame frame = drawn_frame(kind, drawn_seed(key.part, key.seed, key.index), render.dense);
  const Meta identity = identity_of(key, frame.meta.scenario, render);
  frame.meta.split = identity.split;
  frame.meta.part = identity.part;
  frame.meta.seed = identity.seed;
  frame.meta.index = identity.index;
  frame.folder.name = folder_name(frame.meta);
  if (!render.color) frame.folder.color_bgr.clear();
  return frame;
}

void describe(const Stage& stage, const Material& material, Meta& meta) {
  meta.ropes = static_cast<int>(stage.ropes.size());
  const bool cord = stage.ropes.front().cord.has_value();
  meta.material = cord ? "cord" : material.name;
  meta.band = cord ? kAnyColor : material.band;
  meta.hanging = stage.ropes.front().hanging;
  meta.square_ends = stage.ropes.front().square_ends;
  meta.camera = stage.view.sensor->name;
  meta.distance_m = stage.view.distance_m;
  meta.tilt_deg = stage.view.tilt_rad * 180 / std::numbers::pi;
}

// A scene of a key: the ropes, their view and things, and the ideal picture of them.
class Scene {
 public:
  Scene(const SceneKey& key, std::string_view scenario, const Render& render)
      : key_(key), look_(key, Use::kLook), scenario_(scenario) {
    stage_.cords = render.cords;
    stage_.ring_alone = render.ring_alone;
  }

  Result<void> set_up();
  [[nodiscard]] Result<SyntheticFrame> taken(const Render& render) const;

 private:
  Result<bool> stage_once(Dice& ropes, Dice& views, Dice& dice);
  void choose_materials();
  [[nodiscard]] Result<std::vector<float>> depth(const Render& render, Meta& meta) const;

  SceneKey key_;
  Dice look_;
  const Material* material_ = nullptr;      // of the first rope,
  std::vector<const Material*> materials_;  // and of all
  std::string_view scenario_;
  Stage stage_;
  std::optional<Tracer> tracer_;
  Picture picture_;
};

// True when this attempt shows enough of its ropes.
Result<bool> Scene::stage_once(Dice& ropes, Dice& views, Dice& dice) {
  const bool thesis = key_.split == Split::kThesis;
  const auto set_up = thesis                    ? set_up_thesis
                      : has_several(key_.split) ? set_up_several
                                                : set_up_wide;
  if (!set_up(scenario_, ropes, views, stage_)) return false;
  if (stage_.cords) draw_cords(Dice(key_, Use::kCord), stage_.ropes);
  stage_.faults = {};
  if (!thesis) stage_.faults = draw_faults(stage_.ropes, stage_.view, material_->dark, dice);
  for (int k = 0; k < kStagings; ++k) {
    furnish(stage_, dice);
    auto tracer = Tracer::create(stage_.view, stage_.ropes, stage_.things);
    if (!tracer) return tracer.error();
    tracer_.emplace(std::move(*tracer));
    picture_ = tracer_->take_picture();
    if (shows_enough(stage_, picture_)) return true;
    if (stage_.things.empty()) return false;
  }
  return false;
}

// Half of all sets are ropes of one kind, as a workshop has them.
void Scene::choose_materials() {
  materials_.assign(stage_.ropes.size(), material_);
  if (stage_.ropes.size() < 2 || look_.chance(0.5)) return;
  for (std::size_t k = 1; k < materials_.size(); ++k) materials_[k] = &draw_material(look_);
}

Result<void> Scene::set_up() {
  material_ = &draw_material(look_);
  Dice ropes(key_, Use::kRope);
  Dice views(key_, Use::kView);
  Dice things(key_, Use::kThings);
  for (int k = 0; k < kAttempts; ++k) {
    const auto done = stage_once(ropes, views, things);
    if (!done) return done.error();
    if (*done) {
      choose_materials();
      return {};
    }
  }
  return Error{ErrorCode::kInternal,
               fmt::format("make_frame: no rope of scene {} fits its view in {} attempts",
                           key_.index, kAttempts)};
}

/// As the scene's camera measures it.
Result<std::vector<float>> Scene::depth(const Render& render, Meta& meta) const {
  Dice sensor(key_, Use::kSensor, render.frame);
  const View& view = stage_.view;
  const auto rig = render.matched ? rig_of(*view.sensor) : std::nullopt;
  if (!rig) {
    return measured_depth(view, picture_, stage_.ropes, stage_.faults.depth, sensor.word());
  }
  Dice dice(key_, Use::kInfrared, render.frame);
  const auto eyes = infrared(view, *rig, stage_.ropes, stage_.things, dice);
  if (!eyes) return eyes.error();
  meta.camera += ", matched";
  float nearest_m = static_cast<float>(view.sensor->farthest_m);
  for (const float z : picture_.depth_m) nearest_m = z > 0 ? std::min(nearest_m, z) : nearest_m;
  auto depth_m = matched(view, *rig, *eyes, 0.95 * static_cast<double>(nearest_m));
  if (!depth_m) return depth_m.error();
  return spoiled_depth(view, picture_, stage_.ropes, stage_.faults.depth, *std::move(depth_m),
                       sensor.word());
}

Result<SyntheticFrame> Scene::taken(const Render& render) const {
  Dice mask(key_, Use::kMask, render.frame);
  const View& view = stage_.view;
  SyntheticFrame result;
  FrameFolder& folder = result.folder;
  result.meta = identity_of(key_, scenario_, render);
  describe(stage_, *material_, result.meta);
  folder.name = folder_name(result.meta);
  folder.width = view.sensor->width;
  folder.height = view.sensor->height;
  folder.intrinsics = view.camera;
  auto measured = depth(render, result.meta);
  if (!measured) return measured.error();
  folder.depth_m = *std::move(measured);
  folder.mask = segmented_mask(view, picture_, stage_.faults.mask, mask.word());
  for (std::size_t k = 0; k < view.curves.size(); ++k) {
    const Rope& rope = stage_.ropes[k];
    result.ropes.push_back({nodes_of(view.curves[k]), rope.radius_m, rope.closed});
  }
  folder.truth = result.ropes.front().nodes;
  if (has_several(key_.split)) folder.instances = labels_of(picture_);
  if (render.dense) result.dense = {view.curves, picture_.depth_m, picture_.mask};
  if (render.color) {
    Dice light(key_, Use::kLook, render.frame + 1);
    const auto windows = render.windows ? render.windows(result)
                                        : std::vector<Window>{{0, 0, folder.width, folder.height}};
    folder.color_bgr = colored(view, *tracer_, picture_, stage_.things, stage_.ropes, materials_,
                               key_.split != Split::kThesis, windows, light);
  }
  find(view, stage_.ropes.front(), picture_, folder.depth_m, folder.mask, result.meta);
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

Result<Meta> identity(Split split, Part part, std::uint64_t seed, std::uint64_t index,
                      const Render& render) {
  if (const auto good = check(split, part, index, render.frame); !good) return good.error();
  const SceneKey key{split, part, seed, index};
  return identity_of(key, scenario_of(key), render);
}

Result<SyntheticFrame> make_frame(Split split, Part part, std::uint64_t seed, std::uint64_t index,
                                  const Render& render) {
  if (const auto good = check(split, part, index, render.frame); !good) return good.error();
  const SceneKey key{split, part, seed, index};
  if (split == Split::kDrawn) return drawn(key, render);
  Scene scene(key, scenario_of(key), render);
  if (const auto ready = scene.set_up(); !ready) return ready.error();
  return scene.taken(render);
}

Result<SyntheticFrame> frame_at(Split split, Part part, std::uint64_t number,
                                const Render& render) {
  const std::uint64_t count = scene_count(split, part);
  if (count == 0) return make_frame(split, part, 0, number, render);
  return make_frame(split, part, number / count, number % count, render);
}

}  // namespace flowdlo::synth
