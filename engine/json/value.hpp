// Value: what a JSON text says. A tree of our own, for nlohmann's asks for memory in its destructor
// and ends the process where there is none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flowdlo::json {

struct Member;

struct Value {
  enum class Kind : unsigned char { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  bool whole = false;  ///< of a number: written without point and exponent
  double number = 0;   ///< of a boolean 0 or 1
  std::string string;
  std::vector<Value> elements;  ///< of an array
  std::vector<Member> members;  ///< of an object, by key, each key once: as given last

  [[nodiscard]] bool is_number() const { return kind == Kind::kNumber; }
  [[nodiscard]] bool is_string() const { return kind == Kind::kString; }
  [[nodiscard]] bool is_array() const { return kind == Kind::kArray; }
  [[nodiscard]] bool is_object() const { return kind == Kind::kObject; }
  [[nodiscard]] bool is_structured() const { return is_array() || is_object(); }

  /// The member of that key; none where there is no such, or this is no object.
  [[nodiscard]] const Value* find(std::string_view key) const;
};

struct Member {
  std::string key;
  Value value;
};

/// "null", "boolean", "number", "string", "array" or "object".
[[nodiscard]] const char* name_of(Value::Kind kind);

/// As JSON in one line, in ASCII; what arrays and objects within arrays and objects hold is left
/// out.
[[nodiscard]] std::string text_of(const Value& value);

/// In quotes, with JSON's escapes. What is no UTF-8 becomes a replacement character.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace flowdlo::json
