#include "json/parse.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace flowdlo::json {
namespace {

using Kind = Value::Kind;

Value value_of(Kind kind, double number = 0, bool whole = false) {
  Value value;
  value.kind = kind;
  value.number = number;
  value.whole = whole;
  return value;
}

/// Builds the tree from what nlohmann's parser reports.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Builder(Parsed& parsed) : parsed_(parsed) {}

  bool null() override { return put({}); }
  bool boolean(bool value) override { return put(value_of(Kind::kBoolean, value ? 1.0 : 0.0)); }
  bool number_integer(std::int64_t value) override {
    return number(static_cast<double>(value), true);
  }
  bool number_unsigned(std::uint64_t value) override {
    return number(static_cast<double>(value), true);
  }
  bool number_float(double value, const std::string&) override { return number(value, false); }
  bool string(std::string& value) override {
    Value text = value_of(Kind::kString);
    text.string = std::move(value);
    return put(std::move(text));
  }
  bool binary(nlohmann::json::binary_t&) override { return false; }  // no JSON text has any

  bool start_object(std::size_t) override { return open(Kind::kObject); }
  bool start_array(std::size_t) override { return open(Kind::kArray); }
  bool key(std::string& value) override {
    if (depth_ <= kDeepest) open_.back().key = std::move(value);
    return true;
  }
  bool end_object() override {
    if (depth_ <= kDeepest) sort(open_.back().value.members);
    return close();
  }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t byte, const std::string&,
                   const nlohmann::json::exception& fault) override {
    constexpr int kOutOfRange = 406;  // nlohmann's number for what no double can hold
    parsed_.fault_at = byte;
    parsed_.too_large = fault.id == kOutOfRange;
    return false;
  }

 private:
  bool number(double value, bool whole) { return put(value_of(Kind::kNumber, value, whole)); }

  bool open(Kind kind) {
    ++depth_;
    parsed_.depth = std::max(parsed_.depth, depth_);
    if (depth_ <= kDeepest) {
      open_.push_back({{}, value_of(kind)});
      return true;
    }
    return depth_ > kDeepest + 1 || add(value_of(kind));
  }

  bool close() {
    if (depth_-- > kDeepest) return true;
    Value value = std::move(open_.back().value);
    open_.pop_back();
    if (depth_ > 0) return add(std::move(value));
    parsed_.value = std::move(value);
    return true;
  }

  /// A plain value.
  bool put(Value value) {
    if (depth_ > kDeepest) return true;
    if (depth_ > 0) return add(std::move(value));
    parsed_.value = std::move(value);
    return true;
  }

  bool add(Value value) {
    Member& parent = open_.back();
    if (parent.value.is_array()) {
      parent.value.elements.push_back(std::move(value));
    } else {
      parent.value.members.push_back({std::move(parent.key), std::move(value)});
    }
    return true;
  }

  /// By key, the last of those that share one.
  void sort(std::vector<Member>& members) {
    const auto before = [](const Member& a, const Member& b) { return a.key < b.key; };
    std::stable_sort(members.begin(), members.end(), before);
    std::vector<Member> once;
    for (Member& member : members) {
      if (once.empty() || once.back().key != member.key) {
        once.push_back(std::move(member));
      } else {
        parsed_.twice.push_back(member.key);
        once.back() = std::move(member);
      }
    }
    members = std::move(once);
  }

  Parsed& parsed_;
  int depth_ = 0;
  std::vector<Member> open_;  // from the outermost in; `key` is of the member that comes next
};

}  // namespace

Parsed parse(std::string_view text) {
  Parsed parsed;
  Builder builder(parsed);
  parsed.fine = nlohmann::json::sax_parse(text, &builder);
  std::sort(parsed.twice.begin(), parsed.twice.end());
  parsed.twice.erase(std::unique(parsed.twice.begin(), parsed.twice.end()), parsed.twice.end());
  return parsed;
}

}  // namespace flowdlo::json
