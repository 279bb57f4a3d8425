#include "hint_options.hpp"

#include "pixel_argument.hpp"
#include "previous_file.hpp"

namespace flowdlo::tools {

void add_hint_options(CLI::App& command, HintArguments& arguments) {
  command
      .add_option("--first-end", arguments.first_end,
                  "The end of the rope nearest to this pixel becomes node 0")
      ->check(a_pixel())
      ->type_name("U,V");
  command
      .add_option("--end", arguments.ends,
                  "An end of the rope lies about here; once or twice, evidence for the way through "
                  "the mask")
      ->check(a_pixel())
      ->allow_extra_args(false)
      ->type_name("U,V");
  command
      .add_flag("--ring", arguments.ring,
                "The rope is a ring without ends, also where something lies over it")
      ->excludes(command.get_option("--end"));
  command
      .add_option("--previous", arguments.previous,
                  "estimate.json of the frame before: keeps the order of the ends, and the way "
                  "through the mask where the frame leaves it open")
      ->type_name("FILE");
}

Result<Hints> hints_of(const HintArguments& arguments) {
  Hints hints;
  if (const auto pixel = pixel_of(arguments.first_end)) hints.first_end = *pixel;
  for (const std::string& end : arguments.ends) hints.ends.emplace_back(*pixel_of(end));
  if (arguments.ring) hints.closed = true;
  if (arguments.previous.empty()) return hints;
  const auto nodes = read_previous(arguments.previous);
  if (!nodes) return Error{nodes.error().code, "--previous " + nodes.error().message};
  hints.previous = *nodes;
  return hints;
}

}  // namespace flowdlo::tools
