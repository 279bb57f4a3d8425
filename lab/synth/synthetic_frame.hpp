// SyntheticFrame: ropes rendered with everything known about them. A frame is a pure function of
// split, part, seed and index, so that no data set needs to be stored.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"
#include "synth/curve.hpp"

namespace flowdlo::synth {

/// kThesis: nine groups on a table, 0.3 to 0.5 m away, clean depth. kWide: whatever a user brings.
/// kSeveral: the same with two to nine ropes in one mask. kDrawn: lab/scene's tubes in a plain
/// z-buffer, one frame each. kTangled: two to six ropes in one mask that are looped, coiled or
/// folded, and cross each other at any angle.
enum class Split { kThesis, kWide, kSeveral, kDrawn, kTangled };

/// The two never share a scene, whatever the seeds: the part is a bit of every random counter.
enum class Part { kTraining, kValidation };

[[nodiscard]] std::string_view name_of(Split split);
/// Whether the split's scenes show several ropes.
[[nodiscard]] constexpr bool has_several(Split split) {
  return split == Split::kSeveral || split == Split::kTangled;
}
[[nodiscard]] std::string_view name_of(Part part);
[[nodiscard]] std::optional<Split> split_of(std::string_view name);
[[nodiscard]] std::optional<Part> part_of(std::string_view name);

/// Inclusive, OpenCV's ranges: hue 0..180, saturation and value 0..255.
struct HsvBand {
  std::array<int, 3> low{};
  std::array<int, 3> high{};

  friend bool operator==(const HsvBand&, const HsvBand&) = default;
};

/// What makes a scene hard. Each flag is measured on the finished frame, or is set where the part
/// of the scene maker that causes it has run and has left a trace.
struct Defects {
  bool gap = false;             ///< an inner stretch of over 3 radii has no mask
  bool hidden_end = false;      ///< an end has no mask
  bool outside = false;         ///< part of the rope is outside the image
  bool touch = false;           ///< strands lie side by side, or the ends touch
  bool coil = false;            ///< a flat coil of two turns or more
  bool depth_holes = false;     ///< over 6 radii of masked rope, or a fifth of the mask, lack depth
  bool depth_turn = false;      ///< a long depth hole lies where z turns
  bool black_or_shiny = false;  ///< stretches of the rope return no depth
  bool depth_noise = false;     ///< the sensor's noise is modelled: thesis frames have none
  bool flying_pixels = false;   ///< depth between rope and background at its border
  bool edge_dropout = false;    ///< no depth at the rope's border
  bool mask_ragged = false;     ///< frayed border
  bool mask_specks = false;     ///< mask where no rope is
  bool mask_gaps = false;       ///< cuts in the mask that no occluder makes
  bool mask_shifted = false;    ///< eroded or dilated by a pixel
  bool bars = false;            ///< occluder bars are in view
  bool hand = false;            ///< a hand is in view
  bool clutter = false;         ///< other things are on the table or behind

  friend bool operator==(const Defects&, const Defects&) = default;
};

struct Meta {
  std::string scenario;  ///< one of scenarios()
  int ropes = 1;         ///< all else here is of the first, which is the longest
  std::string
      material;  ///< "blue", "red", "green", "cyan-green", "dark-gray"; "cord" with Render::cords
  HsvBand band;  ///< holds the rope's colour where it is lit
  double radius_m = 0;
  double length_m = 0;
  double least_bend_radius_m = 0;  ///< of the centerline
  int crossings = 0;               ///< of the projected centerline
  bool intersection = false;       ///< crossings > 0: sampled twice as often, Sec. 4.1.3
  bool hanging = false;            ///< in free air, held at one or two places

  bool square_ends = false;  ///< false: round caps reach a radius beyond the truth

  std::string camera;     ///< sensor and mode, such as "realsense_d435 848x480"
  double distance_m = 0;  ///< camera to the middle of the rope
  double tilt_deg = 0;    ///< 0: straight down onto the table; of a hanging rope, its plane's tilt
  int occluders = 0;      ///< bars and hands
  Defects defects;

  double width_px = 0;        ///< of the rope at its middle distance
  double visible_share = 0;   ///< of the centerline whose own surface the camera sees
  double depth_share = 0;     ///< of the true rope's masked pixels that have depth
  double longest_gap_m = 0;   ///< of centerline without mask, ends included
  double longest_hole_m = 0;  ///< of centerline with mask but without depth

  std::string split;
  std::string part;
  std::uint64_t seed = 0;
  std::uint64_t index = 0;
  int frame = 0;
  bool cords = false;    ///< Render::cords,
  bool matched = false;  ///< and Render::matched

  /// Gap, touch, coil or holes: where geometry has to guess.
  [[nodiscard]] bool hard() const {
    return defects.gap || defects.touch || defects.coil || defects.depth_holes;
  }
  /// Neither crossing nor gap nor bad depth nor anything else of hard().
  [[nodiscard]] bool easy() const {
    return crossings == 0 && !hard() && !defects.hidden_end && !defects.outside &&
           !defects.mask_gaps && !defects.black_or_shiny;
  }
};

/// Every field, and hard() and easy(), as meta.json has them.
[[nodiscard]] std::string meta_json(const Meta& meta);

/// "000012_coil", and "_003" behind it for any frame but 0. From scenario, index and frame alone.
[[nodiscard]] std::string folder_name(const Meta& meta);

/// Where every rope of a scene runs, in the order of SyntheticFrame::ropes, and what an ideal
/// camera would see of it.
struct DenseTruth {
  std::vector<Curve> curves;       ///< camera frame; samples half a radius apart or less
  std::vector<float> depth_m;      ///< [height, width], without noise; 0: nothing in reach
  std::vector<std::uint8_t> mask;  ///< [height, width], 255: rope
};

/// One rope of a frame.
struct TrueRope {
  Centerline nodes{};  ///< [64, 3] as truth()
  double radius_m = 0;
  bool closed = false;  ///< a ring: the last node is the first
};

struct SyntheticFrame {
  FrameFolder folder;  ///< owns the pixels; its truth is always set, its labels of several ropes
  Meta meta;
  std::vector<TrueRope> ropes;      ///< longest first; label k + 1 of folder.instances is rope k's
  std::optional<DenseTruth> dense;  ///< where Render::dense asks for it

  /// Views into this object.
  [[nodiscard]] Frame frame() const { return folder.frame(); }
  /// [64, 3] uniform in arclength over the whole first rope, hidden parts included.
  [[nodiscard]] const Centerline& truth() const { return *folder.truth; }
};

/// Part of an image, pixels; `right` and `bottom` lie beyond it.
struct Window {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// What to render besides depth and mask.
struct Render {
  bool color = true;  ///< false: color_bgr stays empty, for training records; all else is the same
  int frame = 0;      ///< of this static scene; others differ in sensor noise and light alone.
                      ///< 0 plays the role of the thesis' representative frame 50, Sec. 4.1.1
  bool matched = false;  ///< a stereo camera's depth by matching two infrared pictures, as such
                         ///< cameras do (stereo_pair.hpp), not by a model of their noise
  bool dense = false;    ///< fill SyntheticFrame::dense
  bool cords = false;    ///< ropes are laid of strands, and of any colours (cord.hpp), in place of
                         ///< tubes in the thesis' materials
  bool ring_alone = false;  ///< of a scene of several ropes ("ropes-ring") its ring, and no other
  /// The only parts that get colours, of a frame that has all but these; the rest stays black.
  /// Colours take most of a frame's time. Empty: everything.
  std::function<std::vector<Window>(const SyntheticFrame&)> windows = {};
};

/// Scenes of a part: 234 and 59 for kThesis, as Sec. 4.1.1; 0 for the others: no end.
[[nodiscard]] std::uint64_t scene_count(Split split, Part part);

/// Every name that Meta::scenario can have, in the tables' order.
[[nodiscard]] std::span<const std::string_view> scenarios(Split split);

/// Depth is a whole number of these, in memory as on disk: write depth.png with this scale.
inline constexpr double kDepthScale_m = 1.0e-4;

/// What a scene will show, without rendering it. Fails with kBadInput as make_frame() does.
[[nodiscard]] Result<std::string_view> scenario_of(Split split, Part part, std::uint64_t seed,
                                                   std::uint64_t index);

/// A Meta of which split, part, seed, index, frame, cords, matched and scenario are set. Fails
/// likewise.
[[nodiscard]] Result<Meta> identity(Split split, Part part, std::uint64_t seed, std::uint64_t index,
                                    const Render& render);

/// Scene `index` of a part, the same on every call and thread. `seed` 0 gives the split that the
/// tables use. Fails with kBadInput beyond scene_count(), with kInternal when Embree fails.
[[nodiscard]] Result<SyntheticFrame> make_frame(Split split, Part part, std::uint64_t seed,
                                                std::uint64_t index, const Render& render = {});

/// Frame `number` of seed 0; a split that ends goes on with its next seed. Fails as make_frame.
[[nodiscard]] Result<SyntheticFrame> frame_at(Split split, Part part, std::uint64_t number,
                                              const Render& render = {});

}  // namespace flowdlo::synth
