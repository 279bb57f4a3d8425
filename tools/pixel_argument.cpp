#include "pixel_argument.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

#include "files/shown_name.hpp"

namespace flowdlo::tools {
namespace {

std::optional<float> number_of(std::string_view text) {
  float number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

std::optional<Pixel> pixel_of(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto u = number_of(text.substr(0, comma));
  const auto v = number_of(text.substr(comma + 1));
  if (!u || !v) return std::nullopt;
  return Pixel{*u, *v};
}

CLI::Validator a_pixel() {
  return {[](const std::string& text) {
            return pixel_of(text) ? std::string()
                                  : fmt::format("expected column,row in pixels, got \"{}\"",
                                                files::shown(text));
          },
          "U,V"};
}

}  // namespace flowdlo::tools
