#include "results.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace flowdlo::python {
namespace {

namespace py = pybind11;
using namespace pybind11::literals;

static_assert(sizeof(Centerline) == sizeof(float) * kNodes * 3);

py::array_t<float> array_of(const Centerline& nodes) {
  return py::array_t<float>({kNodes, 3}, &nodes[0].x);
}

/// An array [sizes...] that owns `values`.
template <class Value>
py::array_t<Value> array_of(std::vector<Value>&& values, const std::vector<py::ssize_t>& sizes) {
  auto owner = std::make_unique<std::vector<Value>>(std::move(values));
  Value* data = owner->data();
  const py::capsule keeper(owner.get(),
                           [](void* kept) { delete static_cast<std::vector<Value>*>(kept); });
  static_cast<void>(owner.release());
  return py::array_t<Value>(sizes, data, keeper);
}

py::dict dict_of(const OneRope& one) {
  py::list doubts;
  for (const Doubt doubt : one.doubts) doubts.append(name_of(doubt));
  return py::dict("explained"_a = one.explained, "slender"_a = one.slender, "sides"_a = one.sides,
                  "even"_a = one.even, "left_over"_a = one.left_over, "off_mask"_a = one.off_mask,
                  "bare_gap"_a = one.bare_gap, "goes_on"_a = one.goes_on,
                  "doubts"_a = py::tuple(doubts));
}

py::dict dict_of(const Timings& timings) {
  py::list device;
  for (const auto& [part, ms] : timings.device_ms) device.append(py::make_tuple(text(part), ms));
  return py::dict("evidence_ms"_a = timings.evidence_ms, "field_ms"_a = timings.field_ms,
                  "path_ms"_a = timings.path_ms, "prior_ms"_a = timings.prior_ms,
                  "readings_ms"_a = timings.readings_ms, "beside_ms"_a = timings.beside_ms,
                  "mask_field_ms"_a = timings.mask_field_ms, "model_ms"_a = timings.model_ms,
                  "gate_ms"_a = timings.gate_ms, "total_ms"_a = timings.total_ms,
                  "device_ms"_a = py::tuple(device));
}

}  // namespace

py::str text(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape"));
}

py::dict dict_of(const Estimate& estimate) {
  py::list draws;
  for (const DrawReport& draw : estimate.draws) {
    draws.append(py::dict("accepted"_a = draw.accepted, "finite"_a = draw.finite,
                          "length_ratio"_a = draw.length_ratio,
                          "max_segment_share"_a = draw.max_segment_share,
                          "mask_agreement"_a = draw.mask_agreement));
  }
  py::list alternatives;
  for (const Alternative& other : estimate.alternatives) {
    alternatives.append(py::dict("nodes"_a = array_of(other.nodes), "score"_a = other.score,
                                 "mask_agreement"_a = other.mask_agreement));
  }
  py::list left_out;
  for (const LeftOut part : estimate.left_out) left_out.append(name_of(part));
  py::array_t<bool> support(kNodes);
  for (int node = 0; node < kNodes; ++node) {
    support.mutable_at(node) = estimate.support[static_cast<std::size_t>(node)] != 0;
  }
  return py::dict(
      "nodes"_a = array_of(estimate.nodes), "support"_a = support,
      "sigma_m"_a = py::array_t<float>(kNodes, estimate.sigma_m.data()),
      "confidence"_a = estimate.confidence, "source"_a = name_of(estimate.source),
      "origin"_a = name_of(estimate.origin),
      "draw"_a = estimate.draw < 0 ? py::object(py::none()) : py::object(py::int_(estimate.draw)),
      "calibrated"_a = estimate.calibrated, "readings"_a = estimate.readings,
      "one_rope"_a = dict_of(estimate.one_rope), "mask_agreement"_a = estimate.mask_agreement,
      "prior_mask_agreement"_a = estimate.prior_mask_agreement, "draws"_a = draws,
      "alternatives"_a = alternatives, "timings"_a = dict_of(estimate.timings),
      "closed"_a = estimate.closed, "reversed"_a = estimate.reversed,
      "switched"_a = estimate.switched, "left_out"_a = py::tuple(left_out));
}

py::dict dict_of(Ropes&& ropes, int width, int height) {
  py::list all;
  for (const Estimate& rope : ropes.ropes) all.append(dict_of(rope));
  py::list crossings;
  for (const RopeCrossing& crossing : ropes.crossings) {
    crossings.append(py::dict(
        "over"_a = crossing.over, "under"_a = crossing.under, "over_at_m"_a = crossing.over_at_m,
        "under_at_m"_a = crossing.under_at_m, "apart_m"_a = crossing.apart_m));
  }
  return py::dict("ropes"_a = all, "crossings"_a = crossings,
                  "instances"_a = array_of(std::move(ropes.instances), {height, width}),
                  "parting_ms"_a = ropes.parting_ms, "total_ms"_a = ropes.total_ms);
}

py::array_t<float> array_of(const std::vector<Point3>& points) {
  static_assert(sizeof(Point3) == 3 * sizeof(float));
  const auto count = static_cast<py::ssize_t>(points.size());
  return py::array_t<float>({count, py::ssize_t{3}}, &points.data()->x);
}

py::dict dict_of(const DeviceSurvey& survey) {
  py::list devices;
  for (const DeviceReport& device : survey.vulkan) {
    py::list lacks;
    for (const auto& lack : device.lacks) lacks.append(text(lack));
    const py::object passed = device.self_test_run ? py::object(py::bool_(device.self_test_passed))
                                                   : py::object(py::none());
    devices.append(py::dict("name"_a = text(device.name), "uuid"_a = device.uuid,
                            "kind"_a = name_of(device.kind), "driver"_a = text(device.driver),
                            "api_version"_a = device.api_version,
                            "subgroup_size"_a = device.subgroup_size,
                            "shuffles"_a = device.shuffles, "lacks"_a = py::tuple(lacks),
                            "self_test_passed"_a = passed, "self_test"_a = text(device.self_test)));
  }
  py::list drivers;
  for (const DriverReport& driver : survey.drivers) {
    drivers.append(py::dict("manifest"_a = text(driver.manifest.string()), "used"_a = driver.used,
                            "devices"_a = driver.devices, "verdict"_a = text(driver.verdict),
                            "remembered"_a = driver.remembered));
  }
  return py::dict("drivers"_a = drivers, "unseen"_a = text(survey.unseen), "vulkan"_a = devices,
                  "loader"_a = text(survey.loader), "advice"_a = text(survey.advice),
                  "auto_choice"_a = text(survey.auto_choice));
}

py::dict dict_of(const WeightsInfo& info) {
  py::dict metadata;
  for (const auto& [field, value] : info.metadata) metadata[text(field)] = text(value);
  py::list tensors;
  for (const TensorInfo& tensor : info.tensors) {
    tensors.append(py::dict("name"_a = text(tensor.name),
                            "shape"_a = py::tuple(py::cast(tensor.shape)),
                            "dtype"_a = tensor.dtype));
  }
  return py::dict("metadata"_a = metadata, "tensors"_a = tensors, "parameters"_a = info.parameters,
                  "sha256"_a = info.sha256);
}

py::dict dict_of(FrameFolder&& folder) {
  const py::ssize_t width = folder.width;
  const py::ssize_t height = folder.height;
  const Intrinsics& camera = folder.intrinsics;
  py::object color = py::none();
  if (!folder.color_bgr.empty()) {
    color = array_of(std::move(folder.color_bgr), {height, width, 3});
  }
  py::object instances = py::none();
  if (!folder.instances.empty()) {
    instances = array_of(std::move(folder.instances), {height, width});
  }
  py::object truth = py::none();
  if (folder.truth) truth = array_of(*folder.truth);
  return py::dict("name"_a = text(folder.name),
                  "depth_m"_a = array_of(std::move(folder.depth_m), {height, width}),
                  "mask"_a = array_of(std::move(folder.mask), {height, width}),
                  "intrinsics"_a = py::make_tuple(camera.fx, camera.fy, camera.cx, camera.cy),
                  "color_bgr"_a = color, "instances"_a = instances, "truth"_a = truth);
}

}  // namespace flowdlo::python
