// Masks: mask.hpp as Python sees it.
#pragma once

#include <pybind11/pybind11.h>

namespace flowdlo::python {

/// Adds mask_from_color, mask_from_plane, mask_from_seeds and clean_mask. What their last argument,
/// a dict, does not name keeps the library's default.
void add_masks(pybind11::module_& module);

}  // namespace flowdlo::python
