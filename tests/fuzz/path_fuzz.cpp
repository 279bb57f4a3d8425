// The path alone, on small masks: an error, or traversals that keep what path.hpp promises.
#include "path/path.hpp"

#include <cmath>

#include "drawn_frame.hpp"
#include "promise.hpp"
#include "target.hpp"

namespace {

using flowdlo::Frame;
using flowdlo::Result;
using flowdlo::fuzz::promise;
using flowdlo::path::Path;
using flowdlo::path::Traversals;

constexpr int kMostSide_px = 96;  // so that an execution takes milliseconds

bool unit(float value) { return value >= 0 && value <= 1; }

void check(const Path& path, const Frame& frame) {
  const auto& points = path.points_px;
  promise(points.size() >= 2, "a path has two points");
  promise(path.bridged.size() == points.size(), "every point says whether it is bridged");
  for (std::size_t i = 0; i < points.size(); ++i) {
    promise(points[i].x() >= 0 && points[i].x() <= static_cast<float>(frame.width - 1) &&
                points[i].y() >= 0 && points[i].y() <= static_cast<float>(frame.height - 1),
            "a path stays in the image");
    promise(i == 0 || points[i] != points[i - 1], "consecutive points are distinct");
    promise(path.bridged[i] <= 1, "bridged is 0 or 1");
  }
  promise(unit(path.hidden_ends) && unit(path.buried_ends), "shares of ends are in [0, 1]");
  promise(std::isfinite(path.width_px) && path.width_px >= 0, "a path has a width");
  promise(std::isfinite(path.score), "a path has a score");
}

void check(const Result<Traversals>& traversals, const Frame& frame) {
  if (!traversals) {
    promise(!traversals.error().message.empty(), "an error has words");
    return;
  }
  promise(!traversals->ranked.empty(), "success has a path");
  promise(unit(traversals->margin), "the margin is in [0, 1]");
  promise(std::isfinite(traversals->rope_width_px) && traversals->rope_width_px > 0,
          "the rope has a width");
  for (const Path& path : traversals->ranked) check(path, frame);
}

bool same(const Traversals& a, const Traversals& b) {
  if (a.ranked.size() != b.ranked.size() || a.margin != b.margin) return false;
  for (std::size_t i = 0; i < a.ranked.size(); ++i) {
    if (a.ranked[i].points_px != b.ranked[i].points_px || a.ranked[i].score != b.ranked[i].score) {
      return false;
    }
  }
  return true;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  flowdlo::fuzz::ByteSource bytes({data, size});
  const int choice = bytes.byte();
  const auto drawn = flowdlo::fuzz::draw_frame(bytes, kMostSide_px);
  const Frame frame = drawn.frame();
  if (!flowdlo::validate(frame)) return 0;
  const flowdlo::path::TraceConfig config{.alternatives = choice / 8 % 4,
                                          .rope_length_m = choice >= 128 ? 0.5 : 0.0};
  const auto traversals = flowdlo::path::trace(frame, config);
  check(traversals, frame);
  if (!traversals) return 0;
  if (choice % 8 == 7) {
    const auto again = flowdlo::path::trace(frame, config);
    promise(again && same(*again, *traversals), "the same frame gives the same paths");
  }
  return 0;
}
