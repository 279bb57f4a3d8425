// Config from keyword arguments, and its defaults for those who ask.
#pragma once

#include <pybind11/pybind11.h>

#include "flowdlo/config.hpp"

namespace flowdlo::python {

/// Every field and its default, as keyword arguments would give them.
[[nodiscard]] pybind11::dict default_config();

/// The defaults but for the fields that `given` has. Throws Failure where one is of another type.
[[nodiscard]] Config config_of(const pybind11::dict& given);

}  // namespace flowdlo::python
