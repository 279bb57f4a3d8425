// VerdictMemory: what was found of a driver, kept within this process and in a folder between them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "vulkan/driver_key.hpp"

namespace flowdlo::vulkan {

struct Verdict {
  enum class Kind { kFine, kCrashed, kHung };
  Kind kind = Kind::kFine;
  int devices = 0;              ///< that it listed; of a driver that is not fine 0
  std::string words;            ///< one line: what it did
  std::int64_t at = 0;          ///< when it was found: seconds since 1970
  bool of_this_process = true;  ///< false: recalled from a folder
};

/// Seconds for which a verdict holds that nothing may have changed for: of a driver that is not
/// fine, and of one whose library was not found. Others hold as long as their key.
inline constexpr std::int64_t kShortMemory_s = 24 * 60 * 60;

/// This process's own, or that in `folder` (empty: none); none where it is too old, damaged, of
/// another key, or from the future. `now`: seconds since 1970.
[[nodiscard]] std::optional<Verdict> recall(const DriverKey& key,
                                            const std::filesystem::path& folder, std::int64_t now);

/// What cannot be written is not: the next process asks again.
void remember(const DriverKey& key, const Verdict& verdict, const std::filesystem::path& folder);

/// Tests' way to be a new process: this process's own memory is emptied.
void forget_all();

}  // namespace flowdlo::vulkan
