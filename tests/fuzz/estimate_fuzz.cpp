// `estimate` on small frames, with the model that ships, on the CPU: an error, or an estimate that
// keeps what estimate.hpp promises, with the same bits
// when asked again. The first byte chooses the gate, and whether it is asked again.
#include <cstring>

#include "drawn_frame.hpp"
#include "estimate_promises.hpp"
#include "flowdlo/estimator.hpp"
#include "target.hpp"

namespace {

using flowdlo::Estimate;
using flowdlo::Estimator;
using flowdlo::fuzz::check;
using flowdlo::fuzz::promise;

constexpr int kMostSide_px = 48;

Estimator made(flowdlo::GateChoice gate, flowdlo::PriorChoice prior) {
  auto estimator = Estimator::create({.weights = FLOWDLO_FUZZ_WEIGHTS,
                                      .device = "cpu",
                                      .euler_steps = 1,
                                      .draws = 1,
                                      .prior = prior,
                                      .gate = gate,
                                      .threads = 1,
                                      .max_width = kMostSide_px,
                                      .max_height = kMostSide_px});
  promise(estimator.has_value(), "an estimator can be made");
  return *std::move(estimator);
}

bool same_bits(const Estimate& a, const Estimate& b) {
  return std::memcmp(a.nodes.data(), b.nodes.data(), sizeof(a.nodes)) == 0 &&
         std::memcmp(a.sigma_m.data(), b.sigma_m.data(), sizeof(a.sigma_m)) == 0 &&
         std::memcmp(&a.confidence, &b.confidence, sizeof(float)) == 0 && a.draw == b.draw &&
         a.support == b.support && a.alternatives.size() == b.alternatives.size();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Estimator calibrated =
      made(flowdlo::GateChoice::kCalibrated, flowdlo::PriorChoice::kRefined);
  static Estimator thesis = made(flowdlo::GateChoice::kThesis, flowdlo::PriorChoice::kThesis);
  flowdlo::fuzz::ByteSource bytes({data, size});
  const int choice = bytes.byte();
  Estimator& estimator = choice % 4 == 0 ? thesis : calibrated;
  const auto drawn = flowdlo::fuzz::draw_frame(bytes, kMostSide_px);
  const auto first = estimator.estimate(drawn.frame());
  if (first) check(*first);
  const bool internal = !first && first.error().code == flowdlo::ErrorCode::kInternal;
  promise(!internal, "no frame is a defect of ours");
  if (choice % 8 >= 4) return 0;  // half of the time is for what is new
  const auto second = estimator.estimate(drawn.frame());
  promise(first.has_value() == second.has_value(), "the same frame gives the same answer");
  promise(!first || same_bits(*first, *second), "the same frame gives the same bits");
  return 0;
}
