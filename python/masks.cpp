#include "masks.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "failure.hpp"
#include "flowdlo/mask.hpp"

namespace flowdlo::python {
namespace {

namespace py = pybind11;

using Floats = py::array_t<float, py::array::c_style>;
using Bytes = py::array_t<std::uint8_t, py::array::c_style>;

/// `field` is what `given` has for `name`, or stays.
template <class Value>
void take(const py::dict& given, const char* name, Value& field) {
  if (given.contains(name)) field = given[name].cast<Value>();
}

MaskCleaning cleaning_of(const py::dict& given) {
  MaskCleaning cleaning;
  take(given, "smooth", cleaning.smooth);
  take(given, "fill_holes_px2", cleaning.fill_holes_px2);
  take(given, "least_piece_px2", cleaning.least_piece_px2);
  return cleaning;
}

template <class Image>
Frame of_size(const Image& image) {
  return {.width = static_cast<int>(image.shape(1)),
          .height = static_cast<int>(image.shape(0)),
          .intrinsics = {},
          .depth_m = {},
          .mask = {},
          .color_bgr = {}};
}

std::span<const std::uint8_t> span_of(const Bytes& image) {
  return {image.data(), static_cast<std::size_t>(image.size())};
}

std::span<const float> span_of(const Floats& image) {
  return {image.data(), static_cast<std::size_t>(image.size())};
}

/// [height, width] of what `make` makes, while other threads of Python run.
template <class Make>
Bytes mask_of(const Frame& frame, const Make& make) {
  const Result<Mask> mask = [&] {
    const py::gil_scoped_release released;
    return make();
  }();
  if (!mask) throw Failure(mask.error());
  Bytes array({frame.height, frame.width});
  std::copy(mask->begin(), mask->end(), array.mutable_data());
  return array;
}

Bytes from_color(const Bytes& color, const std::array<std::uint8_t, 3>& rgb,
                 const py::dict& given) {
  ColorBand band{.red = rgb[0], .green = rgb[1], .blue = rgb[2]};
  take(given, "tolerance", band.tolerance);
  take(given, "least_lightness", band.least_lightness);
  take(given, "most_lightness", band.most_lightness);
  band.cleaning = cleaning_of(given);
  Frame frame = of_size(color);
  frame.color_bgr = span_of(color);
  return mask_of(frame, [&] { return mask_from_color(frame, band); });
}

Bytes from_plane(const Floats& depth_m, const std::array<float, 4>& intrinsics,
                 const py::dict& given) {
  HeightBand band;
  take(given, "least_m", band.least_m);
  take(given, "most_m", band.most_m);
  band.cleaning = cleaning_of(given);
  const auto& [fx, fy, cx, cy] = intrinsics;
  Frame frame = of_size(depth_m);
  frame.intrinsics = {fx, fy, cx, cy};
  frame.depth_m = span_of(depth_m);
  return mask_of(frame, [&] { return mask_from_plane(frame, band); });
}

Bytes from_seeds(const Bytes& color, const std::vector<std::array<float, 2>>& seeds,
                 const std::optional<Floats>& depth_m, const py::dict& given) {
  SeedGrowth growth;
  take(given, "tolerance", growth.tolerance);
  take(given, "lightness_tolerance", growth.lightness_tolerance);
  take(given, "depth_step_m", growth.depth_step_m);
  growth.cleaning = cleaning_of(given);
  Frame frame = of_size(color);
  frame.color_bgr = span_of(color);
  if (depth_m) frame.depth_m = span_of(*depth_m);
  std::vector<Pixel> pixels;
  for (const auto& [u, v] : seeds) pixels.push_back({u, v});
  return mask_of(frame, [&] { return mask_from_seeds(frame, pixels, growth); });
}

Bytes cleaned(const Bytes& mask, const py::dict& given) {
  const Frame frame = of_size(mask);
  const MaskCleaning cleaning = cleaning_of(given);
  return mask_of(frame,
                 [&] { return clean_mask(frame.width, frame.height, span_of(mask), cleaning); });
}

}  // namespace

void add_masks(py::module_& module) {
  module.def("mask_from_color", from_color, py::arg("color_bgr").noconvert(), py::arg("rgb"),
             py::arg("given"));
  module.def("mask_from_plane", from_plane, py::arg("depth_m").noconvert(), py::arg("intrinsics"),
             py::arg("given"));
  module.def("mask_from_seeds", from_seeds, py::arg("color_bgr").noconvert(), py::arg("seeds"),
             py::arg("depth_m").noconvert(), py::arg("given"));
  module.def("clean_mask", cleaned, py::arg("mask").noconvert(), py::arg("given"));
}

}  // namespace flowdlo::python
