// PixelArgument: a place in an image as an option says it, "column,row".
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string_view>

#include "flowdlo/hints.hpp"

namespace flowdlo::tools {

/// None where `text` is not two finite numbers with a comma between them.
[[nodiscard]] std::optional<Pixel> pixel_of(std::string_view text);

/// Refuses what pixel_of() does not read.
[[nodiscard]] CLI::Validator a_pixel();

}  // namespace flowdlo::tools
