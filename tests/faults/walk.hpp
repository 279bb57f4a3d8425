// Walk: one thing is done again and again, and each time another call of Vulkan fails.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::testing {

/// Does it: the bits that came, or the Error. By its return all that it made is destroyed. The
/// validation layers may watch where `layers`; of what fails below an instance they crash
/// themselves.
using Action = std::function<Result<std::string>(bool layers)>;

/// Which calls of each function fail: all of them with FLOWDLO_LONG_TESTS in the environment,
/// otherwise the first, one in the middle and the last.
enum class Thoroughly { kSamples, kFirstAlone };

/// Does `once` again and again, each time as in a new process, and fails each function that gives a
/// VkResult, with every result that the specification lets it have. What comes is an Error that is
/// no defect of ours, or the bits that come without a failure (`may_differ`: or others); nothing is
/// left alive; and when a function is through, the next time nothing fails and the bits are right.
/// Where `only` names functions, the others do not fail.
void walk(const Action& once, Thoroughly how, bool may_differ = false,
          const std::set<std::string>& only = {});

}  // namespace flowdlo::testing
