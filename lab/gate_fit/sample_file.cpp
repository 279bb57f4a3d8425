#include "gate_fit/sample_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/whole_file.hpp"

namespace flowdlo::lab {
namespace {

using Json = nlohmann::json;

constexpr int kFormat = 8;  // rises with what a sample holds

/// Calls `field` with the name and value of each number of a candidate.
template <class Candidate, class Field>
void each_number(Candidate& candidate, const Field& field) {
  field("draw", candidate.draw);
  field("hypothesis", candidate.hypothesis);
  field("radius_m", candidate.radius_m);
  field("pixel_m", candidate.pixel_m);
  field("noise_m", candidate.noise_m);
  field("behind", candidate.behind);
  field("readings", candidate.readings);
  field("reread", candidate.reread);
  field("votes", candidate.votes);
  field("odds", candidate.odds);
  field("seen_odds", candidate.seen_odds);
  field("axes_known", candidate.axes.known);
  field("axes_followed", candidate.axes.followed);
  field("axes_backed", candidate.axes.backed);
  field("axes_twice", candidate.axes.twice);
  field("tips_met", candidate.axes.tips_met);
  field("tips_left", candidate.axes.tips_left);
  field("supported", candidate.supported);
  field("bridged", candidate.bridged);
  field("longest_gap", candidate.longest_gap);
  field("hidden_ends", candidate.hidden_ends);
  field("buried_ends", candidate.buried_ends);
  field("ring", candidate.ring);
  field("length_off", candidate.length_off);
  auto& tube = candidate.tube;
  field("mask_recall", tube.mask_recall);
  field("mask_precision", tube.mask_precision);
  field("hidden_share", tube.hidden_share);
  field("depth_agreement", tube.depth_agreement);
  field("depth_bias", tube.depth_bias);
  field("crossing_agreement", tube.crossing_agreement);
  field("overlap_share", tube.overlap_share);
  field("crossings", tube.crossings);
  field("least_sine", tube.least_sine);
  field("least_clearance", tube.least_clearance);
  field("bending", tube.bending);
  field("sharpest_bend", tube.sharpest_bend);
}

Json nodes_json(const Centerline& nodes) {
  Json values = Json::array();
  for (const Point3& node : nodes) {
    for (const float value : {node.x, node.y, node.z}) values.push_back(value);
  }
  return values;
}

Centerline nodes_from(const Json& values) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {values.at(3 * i).get<float>(), values.at(3 * i + 1).get<float>(),
                values.at(3 * i + 2).get<float>()};
  }
  return nodes;
}

Json to_json(const GateSample& sample) {
  Json json{
      {"index", sample.index}, {"scenario", sample.scenario},       {"easy", sample.easy},
      {"hard", sample.hard},   {"truth", nodes_json(sample.truth)}, {"candidates", Json::array()}};
  json["doubted"] = sample.doubted;
  json["several"] = sample.several;
  json["refined"] = Json::array();
  for (const Centerline& nodes : sample.refined) json["refined"].push_back(nodes_json(nodes));
  for (const gate::Candidate& candidate : sample.candidates) {
    Json entry{{"nodes", nodes_json(candidate.nodes)},
               {"sigma_m", candidate.sigma_m},
               {"unseen_m", candidate.unseen_m}};
    each_number(candidate, [&](const char* name, auto value) { entry[name] = value; });
    json["candidates"].push_back(std::move(entry));
  }
  return json;
}

GateSample sample_from(const Json& json) {
  GateSample sample;
  json.at("index").get_to(sample.index);
  json.at("scenario").get_to(sample.scenario);
  json.at("easy").get_to(sample.easy);
  json.at("hard").get_to(sample.hard);
  sample.truth = nodes_from(json.at("truth"));
  json.at("doubted").get_to(sample.doubted);
  json.at("several").get_to(sample.several);
  for (const Json& nodes : json.at("refined")) sample.refined.push_back(nodes_from(nodes));
  for (const Json& entry : json.at("candidates")) {
    gate::Candidate candidate;
    candidate.nodes = nodes_from(entry.at("nodes"));
    for (std::size_t i = 0; i < kNodes; ++i) {
      entry.at("sigma_m").at(i).get_to(candidate.sigma_m[i]);
      entry.at("unseen_m").at(i).get_to(candidate.unseen_m[i]);
    }
    each_number(candidate, [&](const char* name, auto& value) { entry.at(name).get_to(value); });
    sample.candidates.push_back(candidate);
  }
  return sample;
}

Json to_json(const SampleOrigin& origin) {
  return {{"format", kFormat},     {"weights_sha256", origin.weights_sha256},
          {"field", origin.field}, {"split", origin.split},
          {"part", origin.part},   {"first", origin.first},
          {"draws", origin.draws}, {"steps", origin.steps}};
}

}  // namespace

Result<SampleFile> read_samples(const std::filesystem::path& file, const SampleOrigin& origin) {
  SampleFile content;
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) return content;
  int number = 1;
  try {
    const Json head = Json::parse(line);
    if (head.at("origin") != to_json(origin)) return content;
    head.at("scenes").get_to(content.scenes);
    while (std::getline(stream, line)) {
      ++number;
      content.samples.push_back(sample_from(Json::parse(line)));
    }
  } catch (const Json::exception& thrown) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}:{}: expected a sample, got {}; remove the file", file.string(),
                             number, thrown.what())};
  }
  return content;
}

Result<void> write_samples(const std::filesystem::path& file, const SampleOrigin& origin,
                           const SampleFile& content) {
  std::string text = Json{{"origin", to_json(origin)}, {"scenes", content.scenes}}.dump() + '\n';
  for (const GateSample& sample : content.samples) text += to_json(sample).dump() + '\n';
  return files::write_file(file, text);
}

}  // namespace flowdlo::lab
