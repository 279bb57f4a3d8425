// JsonVisitor: a struct's fields by name, read from JSON and written to it by one list of them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::train {

using Json = nlohmann::ordered_json;

/// The words of a choice.
template <class T>
using Names = std::vector<std::pair<const char*, T>>;

/// Reads what is there, keeps the rest, and collects a sentence for each fault.
class ReadVisitor {
 public:
  ReadVisitor(const Json& json, std::string path, std::vector<std::string>& faults)
      : json_(json), path_(std::move(path)), faults_(faults) {}

  void text(const char* key, std::string& value) {
    if (const Json* found = find(key)) {
      if (found->is_string()) {
        value = found->get<std::string>();
      } else {
        fault(key, "text", *found);
      }
    }
  }
  void flag(const char* key, bool& value) {
    if (const Json* found = find(key)) {
      if (found->is_boolean()) {
        value = found->get<bool>();
      } else {
        fault(key, "true or false", *found);
      }
    }
  }
  template <class T>
  void whole(const char* key, T& value, double least, double most) {
    number(key, value, least, most, /*whole=*/true);
  }
  template <class T>
  void real(const char* key, T& value, double least, double most) {
    number(key, value, least, most, /*whole=*/false);
  }
  template <class T>
  void choice(const char* key, T& value, const Names<T>& names) {
    const Json* found = find(key);
    if (found == nullptr) return;
    std::string expected;
    for (const auto& [name, choice] : names) {
      if (found->is_string() && found->get<std::string>() == name) {
        value = choice;
        return;
      }
      expected += (expected.empty() ? "" : ", ") + std::string(name);
    }
    fault(key, "one of " + expected, *found);
  }
  template <class Body>
  void group(const char* key, const Body& body) {
    const Json* found = find(key);
    if (found == nullptr) return;
    if (!found->is_object()) {
      fault(key, "an object", *found);
      return;
    }
    ReadVisitor inside(*found, path_ + key + ".", faults_);
    body(inside);
    inside.refuse_unknown();
  }
  void refuse_unknown() {
    for (const auto& [key, value] : json_.items()) {
      if (!known_.contains(key)) faults_.push_back(fmt::format("{}{}: unknown key", path_, key));
    }
  }

 private:
  template <class T>
  void number(const char* key, T& value, double least, double most, bool whole) {
    const Json* found = find(key);
    if (found == nullptr) return;
    const double number = found->is_number() ? found->get<double>() : least - 1;
    if (number >= least && number <= most && (!whole || number == std::floor(number))) {
      value = static_cast<T>(number);
    } else {
      fault(key, fmt::format("a {}number from {} to {}", whole ? "whole " : "", least, most),
            *found);
    }
  }
  const Json* find(const char* key) {
    known_.insert(key);
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  void fault(const char* key, const std::string& expected, const Json& got) {
    faults_.push_back(fmt::format("{}{}: expected {}, got {}", path_, key, expected, got.dump()));
  }

  const Json& json_;
  std::string path_;
  std::vector<std::string>& faults_;
  std::set<std::string> known_;
};

/// Writes every field.
class WriteVisitor {
 public:
  void text(const char* key, const std::string& value) { json_[key] = value; }
  void flag(const char* key, bool value) { json_[key] = value; }
  template <class T>
  void whole(const char* key, T value, double /*least*/, double /*most*/) {
    json_[key] = value;
  }
  void real(const char* key, double value, double /*least*/, double /*most*/) {
    json_[key] = value;
  }
  void real(const char* key, float value, double /*least*/, double /*most*/) {
    // The shortest decimal that is this float, not the double's digits.
    json_[key] = std::stod(fmt::format("{}", value));
  }
  template <class T>
  void choice(const char* key, T value, const Names<T>& names) {
    for (const auto& [name, choice] : names) {
      if (choice == value) json_[key] = name;
    }
  }
  template <class Body>
  void group(const char* key, const Body& body) {
    WriteVisitor inside;
    body(inside);
    json_[key] = inside.json_;
  }
  [[nodiscard]] std::string dump() const { return json_.dump(2); }

 private:
  Json json_;
};

/// Every key may be left out, none may be unknown. `visit` names the fields of a T, `check` adds
/// faults of fields that do not go together. Fails with kBadInput, listing every fault.
template <class T, class Visit, class Check>
Result<T> parse_fields(const std::string& json, const std::string& where, const Visit& visit,
                       const Check& check) {
  const Json parsed = Json::parse(json, nullptr, /*allow_exceptions=*/false);
  std::vector<std::string> faults;
  T fields;
  if (!parsed.is_object()) {
    faults.emplace_back("expected a JSON object");
  } else {
    ReadVisitor visitor(parsed, "", faults);
    visit(visitor, fields);
    visitor.refuse_unknown();
    check(fields, faults);
  }
  if (faults.empty()) return fields;
  std::string message;
  for (const std::string& fault : faults) {
    message += fmt::format("{}{}: {}", message.empty() ? "" : "\n", where, fault);
  }
  return Error{ErrorCode::kBadInput, message};
}

/// Fails with kIo.
inline Result<std::string> recipe_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    return Error{ErrorCode::kIo,
                 fmt::format("{}: expected a readable recipe; check the path", file.string())};
  }
  return std::string((std::istreambuf_iterator<char>(stream)), {});
}

}  // namespace flowdlo::train
