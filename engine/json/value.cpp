#include "json/value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace flowdlo::json {
namespace {

constexpr double kExact = 9007199254740992;  // 2^53: whole numbers below it are themselves

/// Of one that holds no others.
std::string text_of_leaf(const Value& value) {
  switch (value.kind) {
    case Value::Kind::kBoolean:
      return value.number != 0 ? "true" : "false";
    case Value::Kind::kNumber:
      return value.whole && std::abs(value.number) < kExact
                 ? nlohmann::json(static_cast<std::int64_t>(value.number)).dump()
                 : nlohmann::json(value.number).dump();
    case Value::Kind::kString:
      return escaped(value.string);
    case Value::Kind::kArray:
      return "[]";
    case Value::Kind::kObject:
      return "{}";
    case Value::Kind::kNull:
      break;
  }
  return "null";
}

}  // namespace

const Value* Value::find(std::string_view key) const {
  const auto found = std::lower_bound(
      members.begin(), members.end(), key,
      [](const Member& member, std::string_view wanted) { return member.key < wanted; });
  return found != members.end() && found->key == key ? &found->value : nullptr;
}

const char* name_of(Value::Kind kind) {
  switch (kind) {
    case Value::Kind::kNull:
      return "null";
    case Value::Kind::kBoolean:
      return "boolean";
    case Value::Kind::kNumber:
      return "number";
    case Value::Kind::kString:
      return "string";
    case Value::Kind::kArray:
      return "array";
    case Value::Kind::kObject:
      return "object";
  }
  return "null";
}

std::string text_of(const Value& value) {
  std::string text;
  const auto add = [&](const std::string& one) {
    if (!text.empty()) text += ',';
    text += one;
  };
  if (value.is_array()) {
    for (const Value& element : value.elements) add(text_of_leaf(element));
    return '[' + text + ']';
  }
  if (value.is_object()) {
    for (const Member& member : value.members) {
      add(escaped(member.key) + ':' + text_of_leaf(member.value));
    }
    return '{' + text + '}';
  }
  return text_of_leaf(value);
}

std::string escaped(std::string_view text) {
  using Json = nlohmann::json;
  return Json(text).dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace);
}

}  // namespace flowdlo::json
