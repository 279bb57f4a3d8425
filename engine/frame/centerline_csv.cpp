#include "frame/centerline_csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace flowdlo::frame {
namespace {

// Lines without their ends (LF or CRLF) and without empty ones at the end of the file.
std::vector<std::string_view> lines_of(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    auto line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<float> finite_number(std::string_view text) {
  float value = 0;
  text = trimmed(text);
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Point3> point_of(std::string_view line) {
  const auto first = line.find(',');
  if (first == std::string_view::npos) return std::nullopt;
  const auto second = line.find(',', first + 1);
  if (second == std::string_view::npos) return std::nullopt;
  const auto x = finite_number(line.substr(0, first));
  const auto y = finite_number(line.substr(first + 1, second - first - 1));
  const auto z = finite_number(line.substr(second + 1));
  if (!x || !y || !z) return std::nullopt;
  return Point3{*x, *y, *z};
}

}  // namespace

Result<Centerline> parse_centerline(std::string_view text, const std::string& who) {
  const auto lines = lines_of(text);
  if (lines.empty() || lines[0] != "x,y,z") {
    return Error{ErrorCode::kBadInput, who + ": expected the header x,y,z in line 1"};
  }
  if (lines.size() != kNodes + 1) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected {} rows below the header, got {}; resample the curve",
                             who, kNodes, lines.size() - 1)};
  }
  Centerline nodes{};
  for (std::size_t row = 0; row < nodes.size(); ++row) {
    const auto point = point_of(lines[row + 1]);
    if (!point) {
      return Error{ErrorCode::kBadInput,
                   fmt::format("{}: line {}: expected three finite numbers, got \"{}\"", who,
                               row + 2, lines[row + 1].substr(0, 60))};
    }
    nodes[row] = *point;
  }
  return nodes;
}

std::string format_centerline(std::span<const Point3> points) {
  std::string text = "x,y,z\n";
  for (const auto& point : points) {
    text += fmt::format("{:.9g},{:.9g},{:.9g}\n", point.x, point.y, point.z);
  }
  return text;
}

}  // namespace flowdlo::frame
