// Sweep: a public function is called again and again, and each time memory runs out a little later.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"
#include "support/failing_allocation.hpp"

namespace flowdlo::testing {

/// How many allocations of a function are tried: each of the first, and samples of the rest.
struct Depth {
  long first = 24;
  long samples = 16;
};

/// The whole sweep, with FLOWDLO_LONG_TESTS in the environment.
inline constexpr Depth kWhole = {300, 200};

inline std::vector<long> numbers_to_fail(long total, Depth depth) {
  const bool whole = std::getenv("FLOWDLO_LONG_TESTS") != nullptr;
  const auto [first, samples] = whole ? kWhole : depth;
  std::vector<long> numbers;
  for (long n = 1; n <= std::min(first, total); ++n) numbers.push_back(n);
  const long rest = total - first;
  for (long k = 1; k <= std::min(samples, rest); ++k) {
    numbers.push_back(first + rest * k / std::min(samples, rest));
  }
  return numbers;
}

/// Calls `call`, a function of a Result, with every allocation of numbers_to_fail failing, once and
/// from there on. What comes is kOutOfMemory, or what comes without a failure as `bits` has it; and
/// after an Error the next call gives that again.
template <class Call, class Bits>
void sweep(const char* name, const Call& call, const Bits& bits, Depth depth = {}) {
  auto warm = call();
  ASSERT_TRUE(warm) << name << ": " << warm.error().message;
  const std::string expected = bits(warm);
  const long total = [&] {
    const FailingAllocation counting(Fails::kNever, 0);
    (void)call();
    return FailingAllocation::count();
  }();
  std::map<std::string, long> codes;
  long calls = 0;
  for (const Fails fails : {Fails::kOnce, Fails::kFromOn}) {
    for (const long number : numbers_to_fail(total, depth)) {
      SCOPED_TRACE(std::string(name) + ", allocation " + std::to_string(number) +
                   (fails == Fails::kOnce ? "" : " and all later ones"));
      auto got = [&] {
        const FailingAllocation failing(fails, number);
        return call();
      }();
      ++calls;
      ++codes[got ? "right" : name_of(got.error().code)];
      if (got) {
        EXPECT_EQ(bits(got), expected);
        continue;
      }
      EXPECT_EQ(got.error().code, ErrorCode::kOutOfMemory) << got.error().message;
      auto next = call();
      ASSERT_TRUE(next) << next.error().message;
      EXPECT_EQ(bits(next), expected) << "of the next call";
    }
  }
  std::cout << "[ sweep    ] " << name << ": " << total << " allocations, " << calls << " calls";
  for (const auto& [code, count] : codes) std::cout << ", " << count << " " << code;
  std::cout << std::endl;
}

}  // namespace flowdlo::testing
