// Fringe: slivers of mask beside the rope, parted from it by a dark line, as segmentations leave
// them that bleed over a border they have lost.
#pragma once

#include "image/image.hpp"

namespace flowdlo::path {

/// Empties the pieces of `mask` (0 or 1, empty at its border) that are at most half as thick as the
/// rope and lie alongside a piece as thick as the rope, a pixel or two away; among several of them
/// also crumbs as thick as the rope. Strands of one rope beside each other are equally thick and
/// stay, and so do pieces that lead away. Returns whether any went.
bool erase_fringes(image::Mask& mask);

}  // namespace flowdlo::path
