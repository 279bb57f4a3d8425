#include "config.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "failure.hpp"

namespace flowdlo::python {
namespace {

namespace py = pybind11;

template <class Choice, std::size_t kCount>
using Names = std::array<std::pair<const char*, Choice>, kCount>;

// As the options of the command are called.
constexpr Names<Quality, 3> kQualities{
    {{"auto", Quality::kAuto}, {"full", Quality::kFull}, {"fast", Quality::kFast}}};
constexpr Names<PriorChoice, 3> kPriors{{{"auto", PriorChoice::kOfWeights},
                                         {"thesis", PriorChoice::kThesis},
                                         {"refined", PriorChoice::kRefined}}};
constexpr Names<GateChoice, 3> kGates{{{"auto", GateChoice::kOfWeights},
                                       {"thesis", GateChoice::kThesis},
                                       {"calibrated", GateChoice::kCalibrated}}};
constexpr Names<FieldChoice, 3> kFields{{{"auto", FieldChoice::kBeside},
                                         {"off", FieldChoice::kOff},
                                         {"strands", FieldChoice::kStrands}}};

constexpr Names<FieldDevice, 3> kFieldDevices{
    {{"auto", FieldDevice::kFaster}, {"cpu", FieldDevice::kCpu}, {"device", FieldDevice::kSame}}};

std::string shown(const py::handle& value) { return py::repr(value).cast<std::string>(); }

[[noreturn]] void wrong(const char* name, const std::string& expected, const py::handle& got) {
  refuse(std::string("Estimator: ") + name + ": expected " + expected + ", got " + shown(got));
}

template <class Value>
void take(const char* name, const py::handle& given, Value& field, const char* expected) {
  try {
    field = given.cast<Value>();
  } catch (const py::cast_error&) {
    wrong(name, expected, given);
  }
}

void read(const char* name, const py::handle& given, int& field) {
  take(name, given, field, "an int of 32 bits");
}
void read(const char* name, const py::handle& given, std::uint64_t& field) {
  take(name, given, field, "an int of 0 to 2**64 - 1");
}
void read(const char* name, const py::handle& given, double& field) {
  take(name, given, field, "a float");
}
void read(const char* name, const py::handle& given, bool& field) {
  take(name, given, field, "a bool");
}
void read(const char* name, const py::handle& given, std::string& field) {
  take(name, given, field, "a str");
}
void read(const char* name, const py::handle& given, std::filesystem::path& field) {
  if (!py::isinstance<py::bytes>(given)) wrong(name, "a path", given);
  field = given.cast<std::string>();
}

py::object written(int value) { return py::int_(value); }
py::object written(std::uint64_t value) { return py::int_(value); }
py::object written(double value) { return py::float_(value); }
py::object written(bool value) { return py::bool_(value); }
py::object written(const std::string& value) { return py::str(value); }
py::object written(const std::filesystem::path& value) { return py::bytes(value.string()); }

/// Calls visit(name, field) of every plain field, visit(name, field, names) of every choice.
template <class Visit>
void each_field(Config& config, const Visit& visit) {
  visit("weights", config.weights);
  visit("device", config.device);
  visit("quality", config.quality, kQualities);
  visit("euler_steps", config.euler_steps);
  visit("draws", config.draws);
  visit("seed", config.seed);
  visit("prior", config.prior, kPriors);
  visit("gate", config.gate, kGates);
  visit("field", config.field, kFields);
  visit("field_weights", config.field_weights);
  visit("field_device", config.field_device, kFieldDevices);
  visit("rope_length_m", config.rope_length_m);
  visit("ropes", config.ropes);
  visit("budget_ms", config.budget_ms);
  visit("threads", config.threads);
  visit("max_width", config.max_width);
  visit("max_height", config.max_height);
  visit("device_timeout_ms", config.device_timeout_ms);
  visit("validation", config.validation);
  visit("probe", config.probe);
}

struct Reader {
  const py::dict& given;

  template <class Value>
  void operator()(const char* name, Value& field) const {
    if (given.contains(name)) read(name, given[name], field);
  }

  template <class Choice, std::size_t kCount>
  void operator()(const char* name, Choice& field, const Names<Choice, kCount>& names) const {
    if (!given.contains(name)) return;
    const py::object value = given[name];
    std::string all;
    for (const auto& [word, choice] : names) {
      if (py::isinstance<py::str>(value) && value.equal(py::str(word))) {
        field = choice;
        return;
      }
      all += (all.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    wrong(name, "one of " + all, value);
  }
};

struct Writer {
  py::dict& out;

  template <class Value>
  void operator()(const char* name, const Value& field) const {
    out[name] = written(field);
  }

  template <class Choice, std::size_t kCount>
  void operator()(const char* name, const Choice& field, const Names<Choice, kCount>& names) const {
    for (const auto& [word, choice] : names) {
      if (choice == field) out[name] = py::str(word);
    }
  }
};

}  // namespace

py::dict default_config() {
  Config config;
  py::dict out;
  each_field(config, Writer{out});
  return out;
}

Config config_of(const py::dict& given) {
  Config config;
  each_field(config, Reader{given});
  return config;
}

}  // namespace flowdlo::python
