// Loads a frame folder, estimates it on the CPU with the installed weights, checks the nodes.
// A program that links flowdlo statically has to name the weights.
#include <cmath>
#include <iostream>

#include <flowdlo/flowdlo.hpp>

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: consumer FRAME [WEIGHTS]\n";
    return 2;
  }
  const auto folder = flowdlo::load_frame_folder(argv[1]);
  if (!folder) {
    std::cerr << folder.error().message << '\n';
    return 1;
  }
  flowdlo::Config config;
  config.device = "cpu";
  if (argc == 3) {
    config.weights = argv[2];
  }
  auto estimator = flowdlo::Estimator::create(config);
  if (!estimator) {
    std::cerr << estimator.error().message << '\n';
    return 1;
  }
  const auto estimate = estimator->estimate(folder->frame());
  if (!estimate) {
    std::cerr << estimate.error().message << '\n';
    return 1;
  }
  for (const auto& node : estimate->nodes) {
    if (!std::isfinite(node.x + node.y + node.z) || node.z <= 0) {
      std::cerr << "node: expected finite and before the camera\n";
      return 1;
    }
  }
  std::cout << "flowdlo " << FLOWDLO_VERSION << " on " << estimator->device() << ": "
            << estimate->nodes.size() << " nodes\n";
}
