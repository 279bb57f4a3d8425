// Probe: each Vulkan driver is first asked in a process of its own, so that one that crashes or
// hangs does it there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/devices.hpp"

namespace flowdlo::vulkan {

struct Probing {
  bool on = true;                  ///< false: drivers are loaded unseen
  std::filesystem::path memory{};  ///< where verdicts are kept between processes; empty: nowhere
  int limit_ms = 20000;  ///< from one answer of a driver to the next; sleeping GPUs take seconds
  /// The program that asks; empty: that which belongs to this library, where it is there.
  std::filesystem::path program{};
};

struct Probed {
  std::vector<DriverReport> drivers;  ///< in the loader's order; none where none was asked
  std::string unseen;                 ///< why drivers were not asked; empty: they were

  [[nodiscard]] bool any_bad() const;
  /// What the bad ones did, "a.json: crashed ...; b.json: ..."; empty without any.
  [[nodiscard]] std::string bad() const;
};

/// Never fails. `loader`: the loader's version.
[[nodiscard]] Probed probe(const Probing& probing, const std::string& loader);

/// libexec/flowdlo/flowdlo-probe-0.1 beside the library or program that holds this code: in its
/// folder, or up to three above. Empty where it is not, or where anybody may write.
[[nodiscard]] std::filesystem::path probe_program();

}  // namespace flowdlo::vulkan
