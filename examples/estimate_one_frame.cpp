// estimate_one_frame FRAME: a frame folder in, 64 ordered points of the rope out.
#include <flowdlo/flowdlo.hpp>
#include <iostream>

namespace {

int report(const flowdlo::Error& error) {
  std::cerr << error.message << '\n';
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  // 1. A frame: colour, depth, mask and camera. A live camera fills a flowdlo::Frame itself.
  const auto folder = flowdlo::load_frame_folder(argc > 1 ? argv[1] : ".");
  if (!folder) return report(folder.error());

  // 2. An estimator, once: the best GPU, or the CPU; the weights that ship.
  auto estimator = flowdlo::Estimator::create({});
  if (!estimator) return report(estimator.error());

  // 3. An estimate for every frame.
  const auto estimate = estimator->estimate(folder->frame());
  if (!estimate) return report(estimate.error());

  // 4. The nodes, from one end to the other, in metres; and how far to trust them.
  for (const auto& node : estimate->nodes) {
    std::cout << node.x << ' ' << node.y << ' ' << node.z << '\n';
  }
  std::cerr << "confidence " << estimate->confidence << " on " << estimator->device() << '\n';
}
