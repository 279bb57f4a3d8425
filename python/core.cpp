// flowdlo._core: the C++ interface as Python sees it. The package around it turns whatever arrays
// its callers have into the packed ones that are asked for here.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config.hpp"
#include "failure.hpp"
#include "flowdlo/flowdlo.hpp"
#include "masks.hpp"
#include "results.hpp"

namespace flowdlo::python {
namespace {

namespace py = pybind11;

using Floats = py::array_t<float, py::array::c_style>;
using Bytes = py::array_t<std::uint8_t, py::array::c_style>;
using Labels = py::array_t<std::uint16_t, py::array::c_style>;

/// The value, or the exception that its error is. To be called with the interpreter's lock.
template <class Value>
Value value_of(Result<Value>&& result) {
  if (!result) throw Failure(result.error());
  return *std::move(result);
}

void done(const Result<void>& result) {
  if (!result) throw Failure(result.error());
}

/// What `work` gives; meanwhile other threads of Python run.
template <class Work>
auto without_lock(const Work& work) {
  const py::gil_scoped_release released;
  return work();
}

template <class Value>
std::span<const Value> span_of(const py::array_t<Value, py::array::c_style>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

Frame frame_of(const Floats& depth_m, const Bytes& mask, const std::array<float, 4>& intrinsics,
               const std::optional<Bytes>& color,
               const std::optional<Labels>& instances = std::nullopt) {
  if (depth_m.ndim() != 2) refuse("Estimator.estimate: depth_m: expected two dimensions");
  const auto& [fx, fy, cx, cy] = intrinsics;
  Frame frame{.width = static_cast<int>(depth_m.shape(1)),
              .height = static_cast<int>(depth_m.shape(0)),
              .intrinsics = {fx, fy, cx, cy},
              .depth_m = span_of(depth_m),
              .mask = span_of(mask),
              .color_bgr = {}};
  if (color) frame.color_bgr = span_of(*color);
  if (instances) frame.instances = span_of(*instances);
  return frame;
}

/// [64, 3] as the library has it.
Centerline centerline_of(const Floats& nodes) {
  if (nodes.ndim() != 2 || nodes.shape(0) != kNodes || nodes.shape(1) != 3) {
    refuse("nodes: expected float32 [64, 3], as Estimate.nodes");
  }
  Centerline centerline{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float* const node = nodes.data() + 3 * i;
    centerline[i] = {node[0], node[1], node[2]};
  }
  return centerline;
}

/// A pixel of two numbers, a point of three.
Place place_of(const std::vector<float>& numbers) {
  if (numbers.size() == 2) return Pixel{numbers[0], numbers[1]};
  if (numbers.size() == 3) return Point3{numbers[0], numbers[1], numbers[2]};
  refuse("a place: expected a pixel (u, v) or a point (x, y, z)");
}

Hints hints_of(const py::dict& given) {
  Hints hints;
  if (given.contains("first_end")) {
    hints.first_end = place_of(given["first_end"].cast<std::vector<float>>());
  }
  if (given.contains("ends")) {
    for (const auto& end : given["ends"].cast<std::vector<std::vector<float>>>()) {
      hints.ends.push_back(place_of(end));
    }
  }
  if (given.contains("rope_length_m")) hints.rope_length_m = given["rope_length_m"].cast<double>();
  if (given.contains("closed")) hints.closed = given["closed"].cast<bool>();
  if (given.contains("previous")) {
    hints.previous = centerline_of(given["previous"].cast<Floats>());
  }
  return hints;
}

/// One estimator with the stream that it may follow, whose calls wait for each other when they come
/// from several threads.
class Handle {
 public:
  explicit Handle(const py::dict& given) {
    const Config config = config_of(given);
    tracker_ = value_of(without_lock([&] { return Tracker::create(config); }));
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() = default;

  py::dict estimate(const Floats& depth_m, const Bytes& mask,
                    const std::array<float, 4>& intrinsics, const std::optional<Bytes>& color,
                    const std::optional<Labels>& instances, const py::dict& hints, bool tracked) {
    const Frame frame = frame_of(depth_m, mask, intrinsics, color, instances);
    const Hints known = hints_of(hints);
    return dict_of(value_of(locked([&](Tracker& tracker) {
      return tracked ? tracker.estimate(frame, known) : tracker.estimator()->estimate(frame, known);
    })));
  }

  py::dict estimate_ropes(const Floats& depth_m, const Bytes& mask,
                          const std::array<float, 4>& intrinsics, const std::optional<Bytes>& color,
                          const std::optional<Labels>& instances) {
    const Frame frame = frame_of(depth_m, mask, intrinsics, color, instances);
    return dict_of(value_of(locked([&](Tracker& tracker) {
                     return tracker.estimator()->estimate_ropes(frame);
                   })),
                   frame.width, frame.height);
  }

  py::dict track_ropes(const Floats& depth_m, const Bytes& mask,
                       const std::array<float, 4>& intrinsics, const std::optional<Bytes>& color,
                       const std::optional<Labels>& instances) {
    const Frame frame = frame_of(depth_m, mask, intrinsics, color, instances);
    auto tracked =
        value_of(locked([&](Tracker& tracker) { return tracker.estimate_ropes(frame); }));
    py::dict result = dict_of(std::move(tracked.found), frame.width, frame.height);
    result["numbers"] = py::tuple(py::cast(tracked.numbers));
    result["missing"] = py::tuple(py::cast(tracked.missing));
    return result;
  }

  void configure_tracking(double most_moved_m, int patience) {
    const TrackerConfig config{.most_moved_m = most_moved_m, .patience = patience};
    const auto done = locked([&](Tracker& tracker) { return tracker.configure(config); });
    if (!done) throw Failure(done.error());
  }

  void forget() {
    const auto done = locked([](Tracker& tracker) -> Result<void> {
      tracker.forget();
      return {};
    });
    if (!done) throw Failure(done.error());
  }

  [[nodiscard]] py::str device() {
    return text(value_of(locked(
        [](Tracker& tracker) -> Result<std::string> { return tracker.estimator()->device(); })));
  }
  [[nodiscard]] py::str field_device() {
    return text(value_of(locked([](Tracker& tracker) -> Result<std::string> {
      return tracker.estimator()->field_device();
    })));
  }
  [[nodiscard]] int euler_steps() {
    return value_of(
        locked([](Tracker& tracker) -> Result<int> { return tracker.estimator()->euler_steps(); }));
  }
  [[nodiscard]] int draws() {
    return value_of(
        locked([](Tracker& tracker) -> Result<int> { return tracker.estimator()->draws(); }));
  }

  void close() {
    without_lock([&] {
      const auto lock = alone();
      tracker_.reset();
    });
  }

 private:
  /// In a process that was forked a thread that is not there any more may hold the mutex; the
  /// estimator itself refuses to work there.
  std::unique_lock<std::mutex> alone() {
    return getpid() == process_ ? std::unique_lock(mutex_) : std::unique_lock<std::mutex>();
  }

  template <class Work>
  auto locked(const Work& work) -> decltype(work(std::declval<Tracker&>())) {
    return without_lock([&]() -> decltype(work(std::declval<Tracker&>())) {
      const auto lock = alone();
      if (tracker_) return work(*tracker_);
      return Error{ErrorCode::kBadInput,
                   "Estimator: expected an open one, got one that was closed; make a new one"};
    });
  }

  pid_t process_ = getpid();
  std::mutex mutex_;
  std::optional<Tracker> tracker_;
};

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Failure& failure) {
    const py::object type =
        py::module_::import("flowdlo.errors").attr("of_code")(name_of(failure.code()));
    PyErr_SetObject(type.ptr(), text(failure.what()).ptr());
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::register_exception_translator(translate);

  module.attr("NODES") = kNodes;
  module.attr("VERSION") = FLOWDLO_VERSION;
  py::list codes;
  for (int code = 0; code <= static_cast<int>(ErrorCode::kOutOfMemory); ++code) {
    codes.append(name_of(static_cast<ErrorCode>(code)));
  }
  module.attr("ERROR_CODES") = py::tuple(codes);
  module.def("default_config", default_config);

  py::class_<Handle>(module, "Estimator")
      .def(py::init<const py::dict&>())
      .def("estimate", &Handle::estimate, py::arg("depth_m").noconvert(),
           py::arg("mask").noconvert(), py::arg("intrinsics"), py::arg("color_bgr").noconvert(),
           py::arg("instances").noconvert(), py::arg("hints") = py::dict(),
           py::arg("tracked") = false)
      .def("estimate_ropes", &Handle::estimate_ropes, py::arg("depth_m").noconvert(),
           py::arg("mask").noconvert(), py::arg("intrinsics"), py::arg("color_bgr").noconvert(),
           py::arg("instances").noconvert())
      .def("track_ropes", &Handle::track_ropes, py::arg("depth_m").noconvert(),
           py::arg("mask").noconvert(), py::arg("intrinsics"), py::arg("color_bgr").noconvert(),
           py::arg("instances").noconvert())
      .def("configure_tracking", &Handle::configure_tracking)
      .def("forget", &Handle::forget)
      .def("close", &Handle::close)
      .def_property_readonly("device", &Handle::device)
      .def_property_readonly("field_device", &Handle::field_device)
      .def_property_readonly("euler_steps", &Handle::euler_steps)
      .def_property_readonly("draws", &Handle::draws);

  module.def("curve", [](const Floats& nodes, int points) {
    Estimate estimate;
    estimate.nodes = centerline_of(nodes);
    return array_of(value_of(estimate.curve(points)));
  });
  module.def("load_frame_folder", [](const py::bytes& folder, bool with_mask) {
    const std::string path = folder;
    return dict_of(value_of(without_lock([&] {
      return with_mask ? load_frame_folder(path) : load_frame_folder_without_mask(path);
    })));
  });
  module.def("survey_devices", [](bool self_test, bool probe) {
    return dict_of(without_lock([&] { return survey_devices(self_test, probe); }));
  });
  module.def("inspect_weights", [](const py::bytes& file) {
    const std::string path = file;
    return dict_of(value_of(without_lock([&] { return inspect_weights(path); })));
  });
  module.def("export_safetensors", [](const py::bytes& weights, const py::bytes& output) {
    const std::string from = weights;
    const std::string to = output;
    done(without_lock([&] { return export_safetensors(from, to); }));
  });
  module.def("import_safetensors", [](const py::bytes& input, const py::bytes& weights) {
    const std::string from = input;
    const std::string to = weights;
    done(without_lock([&] { return import_safetensors(from, to); }));
  });
  add_masks(module);
}

}  // namespace flowdlo::python
