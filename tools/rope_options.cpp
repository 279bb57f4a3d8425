#include "rope_options.hpp"

#include <fmt/format.h>

#include <string>

namespace flowdlo::tools {

CLI::Option* add_rope_options(CLI::App& command, RopeArguments& arguments) {
  return command
      .add_option_function<std::string>(
          "--ropes",
          [&arguments](const std::string& number) {
            arguments.several = true;
            arguments.number = number == "auto" ? 0 : std::stoi(number);
          },
          fmt::format("How many ropes a frame shows, 1 to {}, or auto, as many as there are; "
                      "an instances.png in its folder tells as well [one]",
                      kMostRopes))
      ->check(CLI::Range(1, kMostRopes) | CLI::IsMember({"auto"}))
      ->type_name("N");
}

void put_ropes(const RopeArguments& arguments, Config& config) {
  if (arguments.several) config.ropes = arguments.number;
}

}  // namespace flowdlo::tools
