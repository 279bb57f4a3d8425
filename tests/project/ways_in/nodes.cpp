// nodes FRAME: its 64 nodes, with every default: what a program of ten lines gets.
#include <cstdio>
#include <flowdlo/flowdlo.hpp>

int main(int, char** argv) {
  const auto folder = flowdlo::load_frame_folder(argv[1]);
  auto estimator = flowdlo::Estimator::create({.device = "cpu"});
  if (!folder || !estimator)
    return std::puts((folder ? estimator.error() : folder.error()).message.c_str()), 1;
  const auto estimate = estimator->estimate(folder->frame());
  if (!estimate) return std::puts(estimate.error().message.c_str()), 1;
  for (const auto& node : estimate->nodes) std::printf("%.9g %.9g %.9g\n", node.x, node.y, node.z);
}
