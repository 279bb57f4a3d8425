// Durability: whether what is written waits for the disk.
#pragma once

namespace flowdlo {

enum class Durability {
  kSynced,    ///< contents reach the disk before their names do: a power cut leaves old or new
  kUnsynced,  ///< faster; a power cut may leave empty or torn files, the end of a process does not
};

}  // namespace flowdlo
