// DurabilityChoice: whether the command's files wait for the disk.
#pragma once

#include <cstdlib>
#include <string_view>

#include "flowdlo/durability.hpp"

namespace flowdlo::support {

/// Synced, unless the environment says FLOWDLO_FSYNC=0.
inline Durability chosen_durability() {
  const char* choice = std::getenv("FLOWDLO_FSYNC");
  const bool off = choice != nullptr && std::string_view(choice) == "0";
  return off ? Durability::kUnsynced : Durability::kSynced;
}

}  // namespace flowdlo::support
