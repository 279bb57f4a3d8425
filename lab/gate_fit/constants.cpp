#include "gate_fit/constants.hpp"

#include <fmt/format.h>

#include <span>

#include "files/whole_file.hpp"

namespace flowdlo::lab {
namespace {

constexpr std::size_t kColumns = 96;

/// "{1, 2, 3}" broken into lines, from that column on.
std::string list(std::span<const double> values, std::size_t indent) {
  std::string text = "{";
  std::size_t column = indent + 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string number = fmt::format("{:.5g}{}", values[i], i + 1 < values.size() ? "," : "");
    if (column + 1 + number.size() > kColumns) {
      text += '\n' + std::string(indent + 1, ' ');
      column = indent + 1;
    } else if (i > 0) {
      text += ' ';
      ++column;
    }
    text += number;
    column += number.size();
  }
  return text + "}";
}

std::string field(const char* name, std::span<const double> values) {
  return fmt::format("    .{} =\n        {},\n", name, list(values, 8));
}

template <class Rows>
std::string rows(const char* name, const Rows& matrix) {
  std::string text = fmt::format("            .{} = {{{{\n", name);
  for (const auto& row : matrix) text += "                " + list(row, 16) + ",\n";
  return text + "            }},\n";
}

template <class Network>
std::string network(const char* name, const Network& weights) {
  return fmt::format("    .{} =\n        {{\n{}{}{}        }},\n", name,
                     rows("hidden", weights.hidden), rows("bent", weights.bent),
                     rows("straight", weights.straight));
}

}  // namespace

std::string constants_text(const gate::GateWeights& weights, const std::string& name,
                           const std::string& origin) {
  std::string text =
      "// Written by flowdlo-lab gate-fit; do not edit. Each list is in the order of its "
      "features.\n";
  text += fmt::format("// {}\n", origin);
  text +=
      "#include \"gate/calibrated.hpp\"\n\nnamespace flowdlo::gate {\nnamespace {\n\n"
      "// clang-format off\nconstexpr GateWeights kFitted{\n";
  text += field("draw", weights.draw);
  text += fmt::format("    .draw_margin = {:.4f},\n", weights.draw_margin);
  text += network("hypothesis", weights.hypothesis);
  text += fmt::format("    .hypothesis_margin = {:.4f},\n", weights.hypothesis_margin);
  text += network("closeness", weights.closeness);
  text += network("node_error", weights.node_error);
  text += fmt::format("    .sigma_share = {:.4f},\n", weights.sigma_share);
  text += "};\n// clang-format on\n\n}  // namespace\n\n";
  text += fmt::format("const GateWeights& {}() {{ return kFitted; }}\n\n", name);
  return text + "}  // namespace flowdlo::gate\n";
}

Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
  return files::write_file(file, text);
}

}  // namespace flowdlo::lab
