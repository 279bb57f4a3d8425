#include "weights/metadata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {
namespace {

using ops::Parameterization;

template <class Value, std::size_t kCount>
using Names = std::array<std::pair<Value, std::string_view>, kCount>;

constexpr int kMostEvaluations = 64;  // steps, or draws, that an estimator takes

constexpr Names<bool, 2> kSwitches{{{false, "false"}, {true, "true"}}};
constexpr Names<Parameterization, 3> kParameterizations{
    {{Parameterization::kVelocity, "velocity"},
     {Parameterization::kDirect, "direct"},
     {Parameterization::kPreconditioned, "preconditioned"}}};
constexpr Names<NormalizationKind, 2> kNormalizations{
    {{NormalizationKind::kGlobal, "global"}, {NormalizationKind::kFrame, "frame"}}};
constexpr Names<PriorKind, 2> kPriorKinds{
    {{PriorKind::kThesis, "thesis"}, {PriorKind::kRefined, "refined"}}};

template <class Value, std::size_t kCount>
std::string name_in(const Names<Value, kCount>& names, Value value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return std::string{name};
  }
  return "unset";
}

std::string fault(std::string_view field, std::string_view expected, std::string_view got) {
  return fmt::format("metadata {}: expected {}, got {}; see weights/README.md", field, expected,
                     got);
}

/// Takes fields out of the map one by one and notes what is wrong with them.
class FieldReader {
 public:
  FieldReader(const std::map<std::string, std::string>& fields, std::vector<std::string>& faults)
      : fields_(fields), faults_(faults) {}

  void text(const char* field, std::string& value) const {
    if (const auto* found = find(field, "text")) value = *found;
  }

  template <class Value, std::size_t kCount>
  void choice(const char* field, const Names<Value, kCount>& names, Value& value) const {
    std::string expected;
    for (const auto& entry : names) {
      expected += fmt::format("{}{}", expected.empty() ? "" : " or ", entry.second);
    }
    const auto* found = find(field, expected);
    if (found == nullptr) return;
    for (const auto& [candidate, name] : names) {
      if (*found == name) {
        value = candidate;
        return;
      }
    }
    faults_.push_back(fault(field, expected, in_quotes(*found)));
  }

  template <class Number>
  void number(const char* field, Number& value) const {
    const auto* found = find(field, "a number");
    if (found == nullptr || parse(*found, value)) return;
    faults_.push_back(fault(field, "a number", in_quotes(*found)));
  }

  void mean(std::array<float, 3>& value) const {
    constexpr const char* kExpected = "three numbers with commas between";
    const auto* found = find("mean", kExpected);
    if (found == nullptr) return;
    std::array<float, 3> numbers{};
    std::string_view rest = *found;
    bool good = std::count(rest.begin(), rest.end(), ',') == 2;
    for (float& number : numbers) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      good = good && parse(rest.substr(0, comma), number);
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    if (good) {
      value = numbers;
    } else {
      faults_.push_back(fault("mean", kExpected, in_quotes(*found)));
    }
  }

 private:
  [[nodiscard]] const std::string* find(const char* field, std::string_view expected) const {
    const auto found = fields_.find(field);
    if (found != fields_.end()) return &found->second;
    faults_.push_back(fault(field, expected, "none"));
    return nullptr;
  }

  template <class Number>
  static bool parse(std::string_view text, Number& value) {
    Number number{};
    const auto end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, number);
    if (code != std::errc{} || stop != end) return false;
    value = number;
    return true;
  }

  const std::map<std::string, std::string>& fields_;
  std::vector<std::string>& faults_;
};

void check_text(const Metadata& metadata, std::vector<std::string>& faults) {
  const std::array<std::pair<const char*, const std::string*>, 5> texts{
      {{"name", &metadata.name},
       {"version", &metadata.version},
       {"training_data", &metadata.training_data},
       {"licence", &metadata.licence},
       {"notes", &metadata.notes}}};
  for (const auto& [field, text] : texts) {
    if (!is_utf8(*text)) faults.push_back(fault(field, "UTF-8", in_quotes(*text)));
  }
  if (metadata.name.empty()) faults.push_back(fault("name", "a name", "an empty one"));
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80U                     ? 1U
                               : lead >= 0xC2U && lead < 0xE0U  ? 2U
                               : lead >= 0xE0U && lead < 0xF0U  ? 3U
                               : lead >= 0xF0U && lead <= 0xF4U ? 4U
                                                                : 0U;
    if (length == 0 || length > text.size() - i) return false;
    std::uint32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next & 0xC0U) != 0x80U) return false;
      code = code << 6U | (next & 0x3FU);
    }
    const bool overlong = (length == 3 && code < 0x800U) || (length == 4 && code < 0x10000U);
    if (overlong || code > 0x10FFFFU || (code >= 0xD800U && code < 0xE000U)) return false;
    i += length;
  }
  return true;
}

Variant usable(const Variant& variant) {
  Variant result = variant;
  if (result.local_channels != 8) result.local_channels = 6;
  if (result.head_channels != 4) result.head_channels = 3;
  return result;
}

std::map<std::string, std::string> to_fields(const Metadata& metadata) {
  const Variant& variant = metadata.variant;
  const auto& mean = metadata.mean;
  std::map<std::string, std::string> fields{
      {"name", metadata.name},
      {"version", metadata.version},
      {"training_data", metadata.training_data},
      {"licence", metadata.licence},
      {"notes", metadata.notes},
      {"mean", fmt::format("{},{},{}", mean[0], mean[1], mean[2])},
      {"scale", fmt::format("{}", metadata.scale)},
      {"trained", name_in(kSwitches, metadata.trained)},
      {"parameterization", name_in(kParameterizations, variant.parameterization)},
      {"local_channels", fmt::format("{}", variant.local_channels)},
      {"visible_points", name_in(kSwitches, variant.visible_points)},
      {"head_channels", fmt::format("{}", variant.head_channels)},
      {"normalization", name_in(kNormalizations, variant.normalization)},
      {"prior_kind", name_in(kPriorKinds, variant.prior_kind)},
      {"prior_sd", fmt::format("{}", variant.prior_sd)},
      {"local_features_version", fmt::format("{}", variant.local_features_version)}};
  if (metadata.fast_steps != 0) fields["fast_steps"] = fmt::format("{}", metadata.fast_steps);
  if (metadata.fast_draws != 0) fields["fast_draws"] = fmt::format("{}", metadata.fast_draws);
  return fields;
}

Metadata from_fields(const std::map<std::string, std::string>& fields,
                     std::vector<std::string>& faults) {
  Metadata metadata;
  Variant& variant = metadata.variant;
  const FieldReader read{fields, faults};
  read.text("name", metadata.name);
  read.text("version", metadata.version);
  read.text("training_data", metadata.training_data);
  read.text("licence", metadata.licence);
  if (fields.count("notes") != 0) read.text("notes", metadata.notes);
  read.mean(metadata.mean);
  read.number("scale", metadata.scale);
  read.choice("trained", kSwitches, metadata.trained);
  read.choice("parameterization", kParameterizations, variant.parameterization);
  read.number("local_channels", variant.local_channels);
  read.choice("visible_points", kSwitches, variant.visible_points);
  read.number("head_channels", variant.head_channels);
  read.choice("normalization", kNormalizations, variant.normalization);
  read.choice("prior_kind", kPriorKinds, variant.prior_kind);
  read.number("prior_sd", variant.prior_sd);
  read.number("local_features_version", variant.local_features_version);
  if (fields.count("fast_steps") != 0) read.number("fast_steps", metadata.fast_steps);
  if (fields.count("fast_draws") != 0) read.number("fast_draws", metadata.fast_draws);
  return metadata;
}

std::vector<std::string> faults(const Metadata& metadata) {
  std::vector<std::string> list;
  const Variant& variant = metadata.variant;
  const auto text = [](auto value) { return fmt::format("{}", value); };
  check_text(metadata, list);
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(metadata.mean.begin(), metadata.mean.end(), finite)) {
    list.push_back(fault("mean", "finite numbers", to_fields(metadata)["mean"]));
  }
  if (!finite(metadata.scale) || metadata.scale <= 0) {
    list.push_back(fault("scale", "a finite number above 0", text(metadata.scale)));
  }
  if (name_in(kParameterizations, variant.parameterization) == "unset") {
    list.push_back(fault("parameterization", "velocity, direct or preconditioned", "another"));
  }
  if (variant.local_channels != 6 && variant.local_channels != 8) {
    list.push_back(fault("local_channels", "6 or 8", text(variant.local_channels)));
  }
  if (variant.head_channels != 3 && variant.head_channels != 4) {
    list.push_back(fault("head_channels", "3 or 4", text(variant.head_channels)));
  }
  if (name_in(kNormalizations, variant.normalization) == "unset") {
    list.push_back(fault("normalization", "global or frame", "another"));
  }
  if (name_in(kPriorKinds, variant.prior_kind) == "unset") {
    list.push_back(fault("prior_kind", "thesis or refined", "another"));
  }
  if (!finite(variant.prior_sd) || variant.prior_sd <= 0) {
    list.push_back(fault("prior_sd", "a finite number above 0", text(variant.prior_sd)));
  }
  if (variant.local_features_version < 1 || variant.local_features_version > kNewestLocalFeatures) {
    list.push_back(fault("local_features_version", fmt::format("1 to {}", kNewestLocalFeatures),
                         text(variant.local_features_version)));
  }
  for (const auto& [field, value] : {std::pair{"fast_steps", metadata.fast_steps},
                                     std::pair{"fast_draws", metadata.fast_draws}}) {
    if (value < 0 || value > kMostEvaluations) {
      list.push_back(fault(field, fmt::format("0 to {}", kMostEvaluations), text(value)));
    }
  }
  return list;
}

}  // namespace flowdlo::weights
