// Guarded: every public function runs within it, so that nothing that we or a dependency throw
// leaves the library.
#pragma once

#include <exception>

#include "guard/caught.hpp"

namespace flowdlo::guard {

/// What `work`, a function of a Result, gives; an exception becomes an Error that begins with
/// `who`. All that is thrown here derives from std::exception; what does not is the system ending a
/// thread, and must be let through.
template <class Work>
[[nodiscard]] auto guarded(const char* who, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception&) {
    return caught(who);
  }
}

}  // namespace flowdlo::guard
