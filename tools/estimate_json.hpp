// estimate.json: everything about one estimate, spec section 3.
#pragma once

#include <cstdint>
#include <string>

#include "flowdlo/estimate.hpp"
#include "flowdlo/result.hpp"
#include "flowdlo/tracker.hpp"

namespace flowdlo::tools {

/// What the estimate was made of and by.
struct Provenance {
  std::string frame;    ///< name
  std::string device;   ///< "cpu" or the name of the Vulkan device
  std::string weights;  ///< file; empty: the one that ships
  int steps = 0;
  int draws = 0;
  std::uint64_t seed = 0;
  std::string field_device{};  ///< as `device`, of the strand field; empty: there is none
};

/// JSON text with `status` "ok"; numbers that are not finite are null.
[[nodiscard]] std::string estimate_json(const Estimate& estimate, const Provenance& provenance);

/// The same of the first rope, and `ropes`: the nodes of each, whether it is closed, and where it
/// passes over or under which. Of a stream also the `number` that each keeps, and those that are
/// `missing`.
[[nodiscard]] std::string ropes_json(const TrackedRopes& tracked, const Provenance& provenance);

/// JSON text with `status` the code's name and `message` the error's sentence.
[[nodiscard]] std::string failure_json(const Error& error, const Provenance& provenance);

}  // namespace flowdlo::tools
