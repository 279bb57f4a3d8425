// Attempt: what a baseline makes of one frame.
#pragma once

#include <string>
#include <utility>

#include "flowdlo/centerline.hpp"

namespace flowdlo::baselines {

enum class Status {
  kNoOutput,  ///< nothing came out: "failed" in Sec. 4.1.4
  kInvalid,   ///< 64 nodes that fail a validity check of Sec. 4.1.4
  kValid,
};

struct Attempt {
  Status status = Status::kNoOutput;
  std::string reason;  ///< why not valid, a few words that can be counted; empty when valid
  Centerline nodes{};  ///< unless there is no output
};

[[nodiscard]] inline Attempt no_output(std::string reason) {
  return {Status::kNoOutput, std::move(reason), {}};
}

}  // namespace flowdlo::baselines
