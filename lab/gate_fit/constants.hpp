// Constants: fitted weights as the source file that the engine compiles.
#pragma once

#include <filesystem>
#include <string>

#include "flowdlo/result.hpp"
#include "gate/calibrated.hpp"

namespace flowdlo::lab {

/// The whole text of engine/gate/NAME.cpp, whose function is called `name`; `origin` is one line
/// that says what the fit was made on.
[[nodiscard]] std::string constants_text(const gate::GateWeights& weights, const std::string& name,
                                         const std::string& origin);

/// Fails with kIo; no partial file stays.
[[nodiscard]] Result<void> write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace flowdlo::lab
