// The weights files as the target flowdlo::weights holds them: first byte, and the one behind the
// last. No other module of a program sees them.
#pragma once

#include <cstdint>

extern "C" {
[[gnu::visibility("hidden")]] extern const std::uint8_t flowdlo_embedded_model[];
[[gnu::visibility("hidden")]] extern const std::uint8_t flowdlo_embedded_model_end[];
[[gnu::visibility("hidden")]] extern const std::uint8_t flowdlo_embedded_field[];
[[gnu::visibility("hidden")]] extern const std::uint8_t flowdlo_embedded_field_end[];
}
