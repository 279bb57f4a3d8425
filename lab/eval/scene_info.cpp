#include "eval/scene_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <system_error>

#include "files/regular_file.hpp"

namespace flowdlo::eval {
namespace {

constexpr std::uint64_t kMostBytes = 1U << 20U;  // of meta.json

constexpr std::array<const char*, 4> kHard{"gap", "touch", "coil", "depth_holes"};
constexpr std::array<const char*, 4> kNotEasy{"hidden_end", "outside", "depth_turn",
                                              "black_or_shiny"};

Error bad(const std::filesystem::path& file, const std::string& what) {
  return {ErrorCode::kBadInput,
          fmt::format("{}: {}; mend the file, or remove it", file.string(), what)};
}

}  // namespace

bool SceneInfo::hard() const {
  return std::any_of(kHard.begin(), kHard.end(), [&](const char* name) { return has(name); });
}

bool SceneInfo::easy() const {
  return described && crossings == 0 && !hard() &&
         std::none_of(kNotEasy.begin(), kNotEasy.end(),
                      [&](const char* name) { return has(name); });
}

Result<SceneInfo> read_scene_info(const std::filesystem::path& folder) {
  const auto file = folder / "meta.json";
  SceneInfo info;
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) return info;
  const auto content = files::read_text(file, kMostBytes);
  if (!content) return content.error();
  const auto json = nlohmann::json::parse(*content, nullptr, false);
  if (!json.is_object()) return bad(file, "expected a JSON object");
  const auto text = [&](const char* key, std::string& value) {
    const auto found = json.find(key);
    if (found == json.end()) return true;
    if (!found->is_string()) return false;
    value = found->get<std::string>();
    return true;
  };
  if (!text("scenario", info.scenario)) return bad(file, "expected a text for \"scenario\"");
  if (!text("material", info.material)) return bad(file, "expected a text for \"material\"");
  if (const auto found = json.find("crossings"); found != json.end()) {
    if (!found->is_number_integer()) return bad(file, "expected a whole number for \"crossings\"");
    info.crossings = found->get<int>();
  }
  const auto metres = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
  };
  const double radius_m = metres("radius_m");
  if (radius_m > 0) info.gap_widths = metres("longest_gap_m") / (2 * radius_m);
  if (const auto found = json.find("defects"); found != json.end()) {
    if (!found->is_object()) return bad(file, "expected an object for \"defects\"");
    info.described = true;
    for (const auto& [key, value] : found->items()) {
      if (!value.is_boolean()) {
        return bad(file, fmt::format("expected true or false for \"defects.{}\"", key));
      }
      if (value.get<bool>()) info.defects.insert(key);
    }
  }
  return info;
}

}  // namespace flowdlo::eval
