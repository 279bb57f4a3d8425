// `estimate_ropes` with and without labels, and `estimate` with hints, on small frames: an error,
// or what estimate.hpp promises of each rope. The first byte chooses; numbers of the hints follow,
// any bits whatever, and then the frame.
#include <array>
#include <cstring>

#include "drawn_frame.hpp"
#include "estimate_promises.hpp"
#include "flowdlo/estimator.hpp"
#include "promise.hpp"
#include "target.hpp"

namespace {

using flowdlo::Estimator;
using flowdlo::Hints;
using flowdlo::Place;
using flowdlo::fuzz::ByteSource;
using flowdlo::fuzz::check;
using flowdlo::fuzz::promise;

constexpr int kMostSide_px = 48;
constexpr int kMostLabels = 4;

Estimator made(int ropes) {
  auto estimator = Estimator::create({.weights = FLOWDLO_FUZZ_WEIGHTS,
                                      .device = "cpu",
                                      .euler_steps = 1,
                                      .draws = 1,
                                      .ropes = ropes,
                                      .threads = 1,
                                      .max_width = kMostSide_px,
                                      .max_height = kMostSide_px});
  promise(estimator.has_value(), "an estimator can be made");
  return *std::move(estimator);
}

bool no_defect(const flowdlo::Error& error) { return error.code != flowdlo::ErrorCode::kInternal; }

Place place(ByteSource& bytes, bool pixel) {
  if (pixel) return flowdlo::Pixel{bytes.number<float>(), bytes.number<float>()};
  return flowdlo::Point3{bytes.number<float>(), bytes.number<float>(), bytes.number<float>()};
}

Hints hints_of(ByteSource& bytes) {
  const int kinds = bytes.byte();
  Hints hints;
  if ((kinds & 1) != 0) hints.first_end = place(bytes, (kinds & 32) != 0);
  if ((kinds & 2) != 0) hints.ends.push_back(place(bytes, (kinds & 64) != 0));
  if ((kinds & 4) != 0) hints.ends.push_back(place(bytes, (kinds & 128) != 0));
  if ((kinds & 8) != 0) hints.rope_length_m = bytes.number<double>();
  if ((kinds & 14) == 0) hints.closed = (kinds & 32) != 0;
  if ((kinds & 16) != 0) {
    hints.previous.emplace();
    const flowdlo::Point3 from{bytes.number<float>(), bytes.number<float>(), bytes.number<float>()};
    const flowdlo::Point3 step{bytes.number<float>(), bytes.number<float>(), bytes.number<float>()};
    for (std::size_t i = 0; i < hints.previous->size(); ++i) {
      const auto along = static_cast<float>(i);
      (*hints.previous)[i] = {from.x + along * step.x, from.y + along * step.y,
                              from.z + along * step.z};
    }
  }
  return hints;
}

void check_ropes(Estimator& estimator, const flowdlo::Frame& frame) {
  const auto found = estimator.estimate_ropes(frame);
  promise(found || no_defect(found.error()), "no frame is a defect of ours");
  if (!found) return;
  promise(!found->ropes.empty(), "there is a rope where there is no error");
  for (const auto& rope : found->ropes) check(rope);
  const int count = static_cast<int>(found->ropes.size());
  for (const auto& crossing : found->crossings) {
    promise(crossing.over >= 0 && crossing.over < count && crossing.under >= 0 &&
                crossing.under < count,
            "a crossing is one of ropes that there are");
    promise(std::isfinite(crossing.over_at_m) && std::isfinite(crossing.under_at_m),
            "a crossing lies somewhere along both");
  }
  promise(found->instances.size() == frame.mask.size(), "each pixel has a label");
  for (std::size_t i = 0; i < frame.mask.size(); ++i) {
    promise(found->instances[i] <= count, "a label is a rope's number");
    promise(found->instances[i] == 0 || frame.mask[i] > 127, "labels are on the mask");
  }
}

void check_hinted(Estimator& estimator, const flowdlo::Frame& frame, const Hints& hints) {
  const auto found = estimator.estimate(frame, hints);
  promise(found || no_defect(found.error()), "no hint is a defect of ours");
  if (!found) return;
  check(*found);
  // What a stream does: the estimate is the next frame's hint.
  Hints next;
  next.previous = found->nodes;
  const auto again = estimator.estimate(frame, next);
  promise(again.has_value(), "an estimate is a good hint");
  check(*again);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Estimator any_number = made(0);
  static Estimator two = made(2);
  static Estimator one = made(1);
  ByteSource bytes({data, size});
  const int choice = bytes.byte();
  const Hints hints = choice % 4 == 3 ? hints_of(bytes) : Hints{};
  const auto drawn = flowdlo::fuzz::draw_frame(bytes, kMostSide_px);
  flowdlo::Frame frame = drawn.frame();
  std::vector<std::uint16_t> labels;
  if ((choice & 4) != 0) {  // columns of the image in turns
    const int stripe_px = 1 + choice / 8;
    for (std::size_t i = 0; i < frame.mask.size(); ++i) {
      const auto u = static_cast<int>(i) % frame.width;
      labels.push_back(static_cast<std::uint16_t>(u / stripe_px % kMostLabels));
    }
    frame.instances = labels;
  }
  if (choice % 4 == 3) {
    check_hinted(one, frame, hints);
  } else {
    check_ropes(choice % 4 == 0 ? any_number : choice % 4 == 1 ? two : one, frame);
  }
  return 0;
}
