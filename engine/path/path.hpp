// Path: the ordered 2D polyline of the rope in the image, end to end, Sec. 3.3.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::path {

/// One traversal of the mask. Samples are about one pixel apart where the mask backs them; a
/// bridged gap is sampled just as densely.
struct Path {
  std::vector<Eigen::Vector2f> points_px;  ///< [M, 2] (u, v), consecutive ones distinct, M >= 2
  std::vector<std::uint8_t> bridged;       ///< [M] 1 where the sample lies on a link over a gap
  bool ring = false;                       ///< closed: where it begins and ends is a guess
  bool closed = false;                     ///< and nothing shows where: a rope without ends
  float ends_met = 0;                      ///< [0, 1] how like tips two ends look that close it
  float hidden_ends = 0;                   ///< [0, 1] half for each tip where an occluder begins
  float buried_ends = 0;                   ///< [0, 1] half for each end on another strand
  float width_px = 0;                      ///< of the rope, as the mask was read for this one
  double score = 0;                        ///< higher is better; comparable within a frame
};

/// The traversals of one frame, best first; never empty.
struct Traversals {
  std::vector<Path> ranked;
  float margin = 1;         ///< in [0, 1]: 0 when the runner-up ties, 1 when nothing comes near
  float rope_width_px = 0;  ///< median width of the mask across the skeleton
  bool filtered = false;    ///< the mask is noise or texture; what a filter left of it was read
  int strands = 0;          ///< stretches between crossings and ends that the mask was read as
};

struct Region;

struct TraceConfig {
  int alternatives = 3;                     ///< kept beside the best
  double rope_length_m = 0;                 ///< known length; 0: unknown
  std::vector<Eigen::Vector2f> ends{};      ///< where ends are known to be: (x / z, y / z) of the
                                            ///< camera frame, two at most
  std::optional<bool> closed{};             ///< known to be a ring, or to have two ends
  std::shared_ptr<const Region> cleaned{};  ///< as glance() has it, of the same frame; null: not
                                            ///< known yet
};

/// A set of ropes that explains a mask.
struct RopesGuess {
  std::vector<Path> ropes;
  float share = 0;  ///< [0, 1] how likely it is beside the others
};

/// The ropes of one mask, each as one path.
struct RopePaths {
  std::vector<Path> ropes;  ///< never empty; `score` is the set's
  std::vector<float> lead;  ///< [ropes] by how much any set without that rope costs more
  float rope_width_px = 0;  ///< median width of the mask across the skeleton
  bool filtered = false;    ///< the mask is noise or texture; what a filter left of it was read
  std::vector<RopesGuess> guesses{};  ///< the likeliest sets by this frame alone, best first
};

/// Costs by which a set of ropes may trail another one to be told of in RopePaths::lead.
inline constexpr float kMostLead = 6;

/// What a mask tells before its strands are told apart.
struct Glance {
  float rope_width_px = 0;  ///< of the strokes
  float slender = 0;        ///< length of all strokes, in widths
  bool filtered = false;    ///< as Traversals::filtered
  /// The frame's mask as every reading of it begins, for those that are to share it; null where the
  /// mask is too large to be read as it is.
  std::shared_ptr<const Region> cleaned{};
};

/// Expects a valid frame. Fails as `trace` does, of a mask without a stroke.
[[nodiscard]] Result<Glance> glance(const Frame& frame);

/// The plain reading, without a strand field: mask (and depth, where there is any) to ordered
/// paths, along the middle of its strokes. Strands that the mask merges are one to it. Expects a
/// valid frame. Fails with kNoPath, saying why, when the mask holds no stroke a rope could have
/// drawn.
[[nodiscard]] Result<Traversals> trace(const Frame& frame, const TraceConfig& config = {});

/// The cheapest set of ropes that explains the mask: so many, or, with 0, as many as cost least.
/// `before` is evidence: the ropes of the frame before, in this one's pixels. Of sets that the
/// frame hardly tells apart the one is taken that has them. Expects a valid frame and `ropes` in
/// 0..kMostRopes. Fails as `trace` does, and with kNoPath where the mask cannot be that many ropes,
/// or only more than kMostRopes.
[[nodiscard]] Result<RopePaths> trace_ropes(const Frame& frame, int ropes,
                                            const std::vector<Path>& before = {});

/// Whether two paths are one rope's: from end to end, in either direction, never farther apart than
/// a width and a half.
[[nodiscard]] bool same_rope(const Path& a, const Path& b, float width_px);

}  // namespace flowdlo::path
