// RopeOptions: how many ropes a frame shows, from the command line.
#pragma once

#include <CLI/App.hpp>

#include "flowdlo/config.hpp"

namespace flowdlo::tools {

struct RopeArguments {
  bool several = false;  ///< --ropes was given: estimate_ropes() is asked, not estimate()
  int number = 1;        ///< 0: as many as there are
};

/// Adds --ropes. `arguments` must outlive the command's parsing.
CLI::Option* add_rope_options(CLI::App& command, RopeArguments& arguments);

void put_ropes(const RopeArguments& arguments, Config& config);

}  // namespace flowdlo::tools
