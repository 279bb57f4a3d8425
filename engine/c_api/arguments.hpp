// Arguments: what every function of the C interface does with its pointers.
#pragma once

#include <fmt/format.h>

#include <cstddef>

#include "c_api/last_error.hpp"
#include "c_api/sized.hpp"
#include "flowdlo/result.hpp"
#include "guard/guarded.hpp"

namespace flowdlo::c_api {

/// Fails with kBadInput where `argument`, called `name`, is NULL.
[[nodiscard]] inline Result<void> check_there(const void* argument, const char* name) {
  if (argument != nullptr) return {};
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected an address, got NULL; pass one", name)};
}

/// Fills a struct that the caller says is of `bytes` with `value`.
template <class Struct>
[[nodiscard]] flowdlo_status initialise(Struct* given, std::size_t bytes, const Struct& value) {
  return told(guard::guarded(Kind<Struct>::kName, [&]() -> Result<void> {
    if (const auto fits = check_size(given, bytes); !fits) return fits.error();
    write(given, bytes, value);
    return {};
  }));
}

}  // namespace flowdlo::c_api
