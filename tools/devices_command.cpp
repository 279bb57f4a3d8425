#include "devices_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "command_line.hpp"
#include "files/shown_name.hpp"
#include "flowdlo/devices.hpp"
#include "terminal.hpp"
#include "wide_lavapipe.hpp"

namespace flowdlo::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string verdict(const DeviceReport& device) {
  if (!device.self_test_run) return "not run";
  if (!device.self_test.empty()) return device.self_test;
  return device.self_test_passed ? "passed" : "failed";
}

void print_device(const DeviceReport& device) {
  support::tell("{}\n", files::shown(device.name));
  const auto row = [](const char* field, const std::string& value) {
    support::tell("  {:<10} {}\n", field, value);
  };
  row("kind", name_of(device.kind));
  row("driver", device.driver);
  row("Vulkan", device.api_version);
  row("UUID", device.uuid);
  row("subgroup", fmt::format("{}{}", device.subgroup_size,
                              device.shuffles ? "" : ", without shuffles: plain kernels"));
  row("lacks", device.lacks.empty() ? "nothing" : fmt::format("{}", fmt::join(device.lacks, ", ")));
  row("self-test", verdict(device));
  support::tell("\n");
}

/// A line for each driver: what it did when it was asked in a process of its own.
void print_drivers(const DeviceSurvey& survey) {
  if (!survey.unseen.empty()) support::tell("Drivers are loaded unseen: {}\n", survey.unseen);
  for (const auto& driver : survey.drivers) {
    support::tell("{}{}: {}{}\n", driver.used ? "" : "LEFT ALONE ", files::shown(driver.manifest),
                  driver.verdict, driver.remembered ? " (remembered)" : "");
  }
  if (!survey.unseen.empty() || !survey.drivers.empty()) support::tell("\n");
}

void print_table(const DeviceSurvey& survey) {
  support::tell("Vulkan loader: {}\n\n", survey.loader);
  print_drivers(survey);
  for (const auto& device : survey.vulkan) print_device(device);
  if (!survey.advice.empty()) support::tell("No Vulkan device to use.\n  {}\n\n", survey.advice);
  support::tell("cpu\n  {:<10} built in, always there\n\n", "kind");
  support::tell("--device auto takes: {}\n", survey.auto_choice);
}

void print_json(const DeviceSurvey& survey) {
  Json devices = Json::array();
  for (const auto& device : survey.vulkan) {
    devices.push_back({{"name", device.name},
                       {"kind", name_of(device.kind)},
                       {"driver", device.driver},
                       {"api_version", device.api_version},
                       {"uuid", device.uuid},
                       {"subgroup_size", device.subgroup_size},
                       {"shuffles", device.shuffles},
                       {"lacks", device.lacks},
                       {"self_test_run", device.self_test_run},
                       {"self_test_passed", device.self_test_passed},
                       {"self_test", device.self_test}});
  }
  Json drivers = Json::array();
  for (const auto& driver : survey.drivers) {
    drivers.push_back({{"manifest", driver.manifest.string()},
                       {"used", driver.used},
                       {"devices", driver.devices},
                       {"verdict", driver.verdict},
                       {"remembered", driver.remembered}});
  }
  const Json json = {{"loader", survey.loader}, {"drivers", drivers},
                     {"unseen", survey.unseen}, {"vulkan", devices},
                     {"advice", survey.advice}, {"auto_choice", survey.auto_choice}};
  support::tell("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

void add_devices_command(CLI::App& app) {
  auto as_json = std::make_shared<bool>(false);
  auto* command = support::add_command(app, "devices",
                                       "Vulkan devices, their self-tests, and which "
                                       "one --device auto takes");
  command->alias("doctor");
  command->add_flag("--json", *as_json, "Print JSON");
  command->callback([as_json] {
    support::widen_lavapipe("vulkan");
    const auto survey = survey_devices(/*self_test=*/true);
    if (*as_json) {
      print_json(survey);
    } else {
      print_table(survey);
    }
  });
}

}  // namespace flowdlo::tools
