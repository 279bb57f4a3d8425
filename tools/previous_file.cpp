#include "previous_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "files/regular_file.hpp"
#include "files/shown_name.hpp"
#include "json/parse.hpp"

namespace flowdlo::tools {
namespace {

constexpr std::uint64_t kMostBytes = 16U << 20U;  // an estimate.json has some 100 kB
constexpr const char* kRemedy = "name an estimate.json that flowdlo estimate wrote";

std::optional<Point3> point_of(const json::Value& value) {
  if (!value.is_array() || value.elements.size() != 3) return std::nullopt;
  for (const json::Value& element : value.elements) {
    if (!element.is_number() || !std::isfinite(static_cast<float>(element.number))) {
      return std::nullopt;
    }
  }
  const auto at = [&](std::size_t i) { return static_cast<float>(value.elements[i].number); };
  return Point3{at(0), at(1), at(2)};
}

/// Messages begin with `who`.
Result<Centerline> nodes_of(const std::string& text, const std::string& who) {
  const auto parsed = json::parse(text);
  if (!parsed.fine) {
    return Error{ErrorCode::kBadInput, fmt::format("{}: expected JSON, got a fault after {} bytes; "
                                                   "{}",
                                                   who, parsed.fault_at, kRemedy)};
  }
  const json::Value* nodes = parsed.value.find("nodes_m");
  if (nodes == nullptr || !nodes->is_array() || nodes->elements.size() != kNodes) {
    const auto* status = parsed.value.find("status");
    const bool failed = status != nullptr && status->is_string() && status->string != "ok";
    const std::string got = failed ? fmt::format("the failure {}", json::escaped(status->string))
                            : nodes == nullptr || !nodes->is_array()
                                ? std::string("none")
                                : std::to_string(nodes->elements.size());
    return Error{ErrorCode::kBadInput, fmt::format("{}: nodes_m: expected {} points, got {}; {}",
                                                   who, kNodes, got, kRemedy)};
  }
  Centerline centerline;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto point = point_of(nodes->elements[i]);
    if (!point) {
      return Error{ErrorCode::kBadInput,
                   fmt::format("{}: nodes_m: expected three finite numbers at node {}; {}", who, i,
                               kRemedy)};
    }
    centerline[i] = *point;
  }
  return centerline;
}

}  // namespace

Result<Centerline> read_previous(const std::filesystem::path& file) {
  const auto text = files::read_text(file, kMostBytes);
  if (!text) return text.error();
  return nodes_of(*text, files::shown(file));
}

}  // namespace flowdlo::tools
