// flowdlo_seed_weights OUT: the weights that the build ships until a trained model has landed.
#include <cstdio>

#include "weights/calibration.hpp"
#include "weights/weights.hpp"

int main(int argc, char** argv) {
  constexpr std::uint64_t kSeed = 20260101;
  if (argc != 2) {
    std::fputs("usage: flowdlo_seed_weights OUT.fdw\n", stderr);
    return 2;
  }
  // Noise has learned from no prior, so that the estimate rests on the better one.
  flowdlo::weights::Variant variant;
  variant.prior_kind = flowdlo::weights::PriorKind::kRefined;
  auto weights = flowdlo::weights::seeded(variant, kSeed);
  weights.calibration = flowdlo::weights::neutral_calibration();  // for who asks for that gate
  const auto saved = flowdlo::weights::save(weights, argv[1]);
  if (saved) return 0;
  std::fprintf(stderr, "%s\n", saved.error().message.c_str());
  return 1;
}
