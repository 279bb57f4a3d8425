#include "train/commands.hpp"
namespace flowdlo::train {
void add_golden_command(CLI::App&, int&) {}
}  // namespace flowdlo::train
