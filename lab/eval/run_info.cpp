#include "eval/run_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "flowdlo/version.hpp"

namespace flowdlo::eval {
namespace {

using nlohmann::json;

constexpr int kFormat = 1;

const char* name_of(PriorChoice prior) {
  switch (prior) {
    case PriorChoice::kThesis:
      return "thesis";
    case PriorChoice::kRefined:
      return "refined";
    case PriorChoice::kOfWeights:
      break;
  }
  return "auto";
}

const char* name_of(GateChoice gate) {
  switch (gate) {
    case GateChoice::kThesis:
      return "thesis";
    case GateChoice::kCalibrated:
      return "calibrated";
    case GateChoice::kOfWeights:
      break;
  }
  return "auto";
}

std::string value_of(const std::map<std::string, std::string>& settings, const std::string& name) {
  const auto found = settings.find(name);
  return found == settings.end() ? "nothing" : found->second;
}

void add(std::string& words, const std::string& more) {
  if (!words.empty()) words += ", ";
  words += more;
}

std::string frames_difference(const RunInfo& a, const RunInfo& b) {
  if (a.frames == b.frames) return {};
  if (a.frames.size() != b.frames.size()) {
    return fmt::format("{} and {} frames", a.frames.size(), b.frames.size());
  }
  const auto [one, other] = std::mismatch(a.frames.begin(), a.frames.end(), b.frames.begin());
  return fmt::format("frame {} is \"{}\" and \"{}\"", one - a.frames.begin(), *one, *other);
}

}  // namespace

std::map<std::string, std::string> settings_of(const Config& config,
                                               const std::string& weights_sha256) {
  return {{"version", FLOWDLO_VERSION},
          {"weights_sha256", weights_sha256},
          {"draws", fmt::format("{}", config.draws)},
          {"steps", fmt::format("{}", config.euler_steps)},
          {"seed", fmt::format("{}", config.seed)},
          {"prior", name_of(config.prior)},
          {"gate", name_of(config.gate)},
          {"rope_length_m", fmt::format("{}", config.rope_length_m)}};
}

std::string difference(const RunInfo& a, const RunInfo& b) {
  std::string words;
  auto names = a.settings;
  names.insert(b.settings.begin(), b.settings.end());
  for (const auto& entry : names) {
    const std::string one = value_of(a.settings, entry.first);
    const std::string other = value_of(b.settings, entry.first);
    if (one != other) add(words, fmt::format("{} is {} and {}", entry.first, one, other));
  }
  if (const auto frames = frames_difference(a, b); !frames.empty()) add(words, frames);
  return words;
}

std::string run_info_json(const RunInfo& info) {
  return json{{"flowdlo_rows", kFormat}, {"settings", info.settings},
              {"weights", info.weights}, {"device", info.device},
              {"frames", info.frames},   {"shard", {info.shard.index, info.shard.count}}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<RunInfo> parse_run_info(std::string_view line, const std::string& who) {
  const json found = json::parse(line, nullptr, false);
  try {
    if (found.at("flowdlo_rows") == kFormat) {
      RunInfo info{found.at("settings").get<std::map<std::string, std::string>>(),
                   found.at("weights").get<std::string>(),
                   found.at("device").get<std::string>(),
                   found.at("frames").get<std::vector<std::string>>(),
                   {found.at("shard").at(0).get<int>(), found.at("shard").at(1).get<int>()}};
      if (info.shard.index >= 1 && info.shard.index <= info.shard.count) return info;
    }
  } catch (const json::exception&) {  // the sentence below says it better
  }
  return Error{ErrorCode::kBadInput,
               fmt::format("{}: expected the rows of a flowdlo eval of version {} of the format, "
                           "got something else; remove the file",
                           who, kFormat)};
}

std::string heading(const RunInfo& info, const std::string& devices) {
  return fmt::format("# Evaluation\n\n{} draws of {} steps on {}; weights: {}.\n\n",
                     value_of(info.settings, "draws"), value_of(info.settings, "steps"), devices,
                     info.weights.empty() ? "those that ship" : info.weights);
}

}  // namespace flowdlo::eval
