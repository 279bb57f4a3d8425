// Gate: the plausibility check and fallback, Eq. (3.30)-(3.33).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::gate {

struct Limits {
  float min_length_ratio = 0.5F;       ///< Eq. (3.31)
  float max_length_ratio = 2.0F;       ///< Eq. (3.31)
  float max_segment_share = 0.10F;     ///< Eq. (3.31)
  float mask_agreement_slack = 0.05F;  ///< Eq. (3.32)
  float mask_dilation_px = 4.0F;       ///< Sec. 3.6, of a 640-px-wide image
};

/// The mask dilated by a disc of mask_dilation_px * width / 640 pixels. A view of the frame's mask,
/// which has to outlive it.
class DilatedMask {
 public:
  DilatedMask(const Frame& frame, const Limits& limits = {});

  /// S_M(X), Eq. (3.32): the share of one-pixel samples along the projected curve that fall on the
  /// dilated mask, in [0, 1]. A segment is sampled 0, 1, 2, ... px from its start, at least once;
  /// the last node closes the curve. Samples outside the image are misses. A segment with an end
  /// behind the camera has no finite projection: it misses as often as the image's diagonal is
  /// long. A centerline that is not finite: 0.
  [[nodiscard]] float agreement(const Centerline& nodes, const Intrinsics& camera) const;

 private:
  int width_;
  int height_;
  std::span<const std::uint8_t> mask_;  ///< [height, width]
  std::vector<int> half_widths_;        ///< px, of the disc, by rows from its centre
};

struct Verdict {
  Source source = Source::kPrior;
  int draw = -1;  ///< accepted draw of highest mask agreement, ties to the lower index; -1: prior
  float prior_agreement = 0;
  std::vector<DrawReport> draws;
};

/// Eq. (3.33) over D draws, each against the prior it was conditioned on (`priors[d]`).
/// `fallback_prior` is what the verdict returns when no draw is accepted.
[[nodiscard]] Verdict choose(std::span<const Centerline> predictions,
                             std::span<const Centerline> priors, const Centerline& fallback_prior,
                             const DilatedMask& mask, const Intrinsics& camera,
                             const Limits& limits = {});

}  // namespace flowdlo::gate
