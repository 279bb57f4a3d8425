// FlowDLO: the complete ordered 3D centerline of a rope from one RGB-D frame.
#pragma once

#include "flowdlo/config.hpp"        // IWYU pragma: export
#include "flowdlo/devices.hpp"       // IWYU pragma: export
#include "flowdlo/durability.hpp"    // IWYU pragma: export
#include "flowdlo/estimate.hpp"      // IWYU pragma: export
#include "flowdlo/estimator.hpp"     // IWYU pragma: export
#include "flowdlo/frame.hpp"         // IWYU pragma: export
#include "flowdlo/frame_folder.hpp"  // IWYU pragma: export
#include "flowdlo/hints.hpp"         // IWYU pragma: export
#include "flowdlo/mask.hpp"          // IWYU pragma: export
#include "flowdlo/result.hpp"        // IWYU pragma: export
#include "flowdlo/tracker.hpp"       // IWYU pragma: export
#include "flowdlo/version.hpp"       // IWYU pragma: export
#include "flowdlo/weights.hpp"       // IWYU pragma: export
