// Results: what the library gives, as dicts whose keys are the fields of flowdlo.results' classes.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "flowdlo/devices.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame_folder.hpp"
#include "flowdlo/weights.hpp"

namespace flowdlo::python {

[[nodiscard]] pybind11::dict dict_of(const Estimate& estimate);
/// `width` and `height` are the frame's.
[[nodiscard]] pybind11::dict dict_of(Ropes&& ropes, int width, int height);
[[nodiscard]] pybind11::dict dict_of(const DeviceSurvey& survey);
[[nodiscard]] pybind11::dict dict_of(const WeightsInfo& info);

/// The arrays take the folder's pixels over; nothing is copied.
[[nodiscard]] pybind11::dict dict_of(FrameFolder&& folder);

/// [points, 3]
[[nodiscard]] pybind11::array_t<float> array_of(const std::vector<Point3>& points);

/// Text that may hold bytes of a path that are no UTF-8.
[[nodiscard]] pybind11::str text(const std::string& bytes);

}  // namespace flowdlo::python
