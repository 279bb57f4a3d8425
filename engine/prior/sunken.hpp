// Sunken: stretches of a rope for which the camera reports what lies behind it.
#pragma once

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// Drops the readings of stretches that lie close to the depth beside the mask while the rope
/// before or after them hangs high over it: nearer by more than a rope can bend away. Nothing is
/// dropped where little of the rope hangs: then it lies there, and something nearer is in the mask.
void drop_sunken(Strip& strip);

}  // namespace flowdlo::prior
