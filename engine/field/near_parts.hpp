// NearParts: where a rope comes much nearer to the camera than in its middle. It is wider there
// than the region was made for; another look, less magnified, sees those parts as it should.
#pragma once

#include "field/block_map.hpp"
#include "field/channel.hpp"
#include "field/region.hpp"
#include "field/strand_field.hpp"
#include "image/image.hpp"

namespace flowdlo::field {

/// log2 of the rope's width over kRope_px where it is much wider than that, in the median; 0 where
/// hardly any of it is.
[[nodiscard]] float wide_octaves(const Channels& field);

/// How much the other look counts at each place of a field.
class NearParts {
 public:
  /// Of a field, for a look at which the rope is `octaves` wider, log2; above 0.
  NearParts(const Channels& field, float octaves);

  /// [0, 1] at a pixel of the field: 0 where the rope is as wide as expected, 1 where it is as wide
  /// as the other look expects.
  [[nodiscard]] float share(int u, int v) const;

  /// Those of `blocks`, of `other`, that lie where shares of the field of `base` are not 0, and
  /// those around them.
  [[nodiscard]] BlockMap needed(const BlockMap& blocks, const Region& other,
                                const Region& base) const;

 private:
  image::Image<float> cells_;  // shares at the middles of squares
};

/// Puts what `other` says into `field` by those shares; widths are of the region of `field`.
void blend(StrandField& field, const StrandField& other, const NearParts& parts, float octaves);

}  // namespace flowdlo::field
