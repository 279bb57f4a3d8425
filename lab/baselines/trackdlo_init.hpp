// TrackDLO-init: the baseline of Sec. 4.1.2, after the thirteen points of field section 1.
#pragma once

#include "baselines/attempt.hpp"
#include "baselines/observation.hpp"

namespace flowdlo::baselines {

/// `repaired`: costs that are no numbers are mended, no segment lacks its rectangle, points that
/// repeat are dropped; everything else as it is. Validity by Sec. 4.1.4. Direction is arbitrary:
/// score it by Eq. (4.3).
[[nodiscard]] Attempt trackdlo_init(const Observation& observation, bool repaired);

/// Sec. 4.1.4: finite, in front of the camera, inside the image, at most 3 px from the mask on
/// average. `mask` is [h, w] u8, set where not 0.
[[nodiscard]] Attempt checked(const Centerline& nodes, const cv::Mat& mask,
                              const Intrinsics& camera);

}  // namespace flowdlo::baselines
