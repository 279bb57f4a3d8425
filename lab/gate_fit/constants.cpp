#include "gate_fit/constants.hpp"

#include <fmt/format.h>

#include <fstream>
#include <span>
#include <system_error>

namespace flowdlo::lab {
namespace {

constexpr std::size_t kColumns = 96;

std::string list(const char* field, std::span<const double> values) {
  std::string text = fmt::format("    .{} =\n        {{", field);
  std::size_t column = 9;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string number = fmt::format("{:.4f}{}", values[i], i + 1 < values.size() ? "," : "");
    if (column + 1 + number.size() > kColumns) {
      text += "\n         ";
      column = 9;
    } else if (i > 0) {
      text += ' ';
      ++column;
    }
    text += number;
    column += number.size();
  }
  return text + "},\n";
}

}  // namespace

std::string constants_text(const gate::GateWeights& weights, const std::string& origin) {
  std::string text =
      "// Written by flowdlo_gate_fit; do not edit. Each list is in the order of its features.\n";
  text += fmt::format("// {}\n", origin);
  text +=
      "#include \"gate/calibrated.hpp\"\n\nnamespace flowdlo::gate {\nnamespace {\n\n"
      "// clang-format off\nconstexpr GateWeights kFitted{\n";
  text += list("draw", weights.draw);
  text += fmt::format("    .draw_margin = {:.4f},\n", weights.draw_margin);
  text += list("hypothesis", weights.hypothesis);
  text += fmt::format("    .hypothesis_margin = {:.4f},\n", weights.hypothesis_margin);
  text += list("closeness", weights.closeness);
  text += list("sigma", weights.sigma);
  return text +
         "};\n// clang-format on\n\n}  // namespace\n\nconst GateWeights& fitted_weights() { "
         "return "
         "kFitted; }\n\n}  // namespace flowdlo::gate\n";
}

Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path temporary = file.string() + ".tmp";
  std::ofstream stream(temporary);
  stream << text;
  stream.close();
  std::error_code failure;
  if (stream) std::filesystem::rename(temporary, file, failure);
  if (stream && !failure) return {};
  std::filesystem::remove(temporary, failure);
  return Error{ErrorCode::kIo, fmt::format("{}: cannot be written", file.string())};
}

}  // namespace flowdlo::lab
