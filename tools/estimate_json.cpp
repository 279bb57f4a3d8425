#include "estimate_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "flowdlo/version.hpp"

namespace flowdlo::tools {
namespace {

using Json = nlohmann::ordered_json;

// Seven digits are all that a float holds; a double would show its rounding.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr);
}

Json numbers(const Point3& point) {
  return Json::array({number(point.x), number(point.y), number(point.z)});
}

Json header(const char* status, const std::string& message, const Provenance& provenance) {
  return {{"status", status},
          {"message", message},
          {"frame", provenance.frame},
          {"version", FLOWDLO_VERSION},
          {"device", provenance.device},
          {"field_device",
           provenance.field_device.empty() ? Json(nullptr) : Json(provenance.field_device)},
          {"weights", provenance.weights.empty() ? Json(nullptr) : Json(provenance.weights)},
          {"steps", provenance.steps},
          {"seed", provenance.seed}};
}

const char* words(Origin prior) {
  switch (prior) {
    case Origin::kRunnerUp:
      return "the prior of a runner-up, another way through the mask,";
    case Origin::kOtherReading:
      return "a prior that another reading of the frame found";
    case Origin::kFrameBefore:
      return "the rope as it was in the frame before";
    default:
      return "the first prior";
  }
}

std::string sentence(const Estimate& estimate) {
  const auto supported = std::count(estimate.support.begin(), estimate.support.end(), 1);
  std::string origin = "no draw of the model passed the gate, so this is the prior";
  if (estimate.source == Source::kPrediction) {
    origin = fmt::format("draw {} of the model passed the gate", estimate.draw);
  } else if (estimate.draws.empty()) {
    origin = fmt::format("the model was not asked, and {} was taken", words(estimate.origin));
  } else if (estimate.calibrated) {
    origin =
        fmt::format("the gate preferred {} to every draw of the model", words(estimate.origin));
  }
  return fmt::format(
      "{}; {:.0f} % of the curve lies on the mask and {} of {} nodes are backed by "
      "visible points",
      origin, 100 * estimate.mask_agreement, supported, kNodes);
}

Json draws_json(const std::vector<DrawReport>& draws) {
  Json list = Json::array();
  for (const auto& draw : draws) {
    list.push_back({{"accepted", draw.accepted},
                    {"finite", draw.finite},
                    {"length_ratio", number(draw.length_ratio)},
                    {"max_segment_share", number(draw.max_segment_share)},
                    {"mask_agreement", number(draw.mask_agreement)}});
  }
  return list;
}

Json nodes_json(const Centerline& nodes) {
  Json list = Json::array();
  for (const auto& node : nodes) list.push_back(numbers(node));
  return list;
}

Json alternatives_json(const std::vector<Alternative>& alternatives) {
  Json list = Json::array();
  for (const auto& alternative : alternatives) {
    list.push_back({{"score", number(alternative.score)},
                    {"mask_agreement", number(alternative.mask_agreement)},
                    {"nodes_m", nodes_json(alternative.nodes)}});
  }
  return list;
}

Json one_rope_json(const OneRope& one) {
  Json doubts = Json::array();
  for (const Doubt doubt : one.doubts) doubts.push_back(name_of(doubt));
  return {{"doubts", std::move(doubts)},      {"explained", number(one.explained)},
          {"slender", number(one.slender)},   {"sides", number(one.sides)},
          {"even", number(one.even)},         {"left_over", number(one.left_over)},
          {"off_mask", number(one.off_mask)}, {"bare_gap", number(one.bare_gap)},
          {"goes_on", number(one.goes_on)}};
}

Json timings_json(const Timings& timings) {
  return {
      {"evidence", number(timings.evidence_ms)}, {"field", number(timings.field_ms)},
      {"path", number(timings.path_ms)},         {"prior", number(timings.prior_ms)},
      {"readings", number(timings.readings_ms)}, {"mask_field", number(timings.mask_field_ms)},
      {"model", number(timings.model_ms)},       {"gate", number(timings.gate_ms)},
      {"total", number(timings.total_ms)},       {"readings_beside", number(timings.beside_ms)}};
}

Json device_timings_json(const Timings& timings) {
  Json stages = Json::object();
  for (const auto& [stage, milliseconds] : timings.device_ms) stages[stage] = number(milliseconds);
  return stages;
}

// Paths and driver names may hold any bytes; JSON may not.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json whole_json(const Estimate& estimate, const Provenance& provenance) {
  Json json = header("ok", sentence(estimate), provenance);
  json["source"] = name_of(estimate.source);
  json["origin"] = name_of(estimate.origin);
  json["draw"] = estimate.draw < 0 ? Json(nullptr) : Json(estimate.draw);
  json["gate"] = estimate.calibrated ? "calibrated" : "thesis";
  json["confidence"] = number(estimate.confidence);
  json["closed"] = estimate.closed;
  json["one_rope"] = one_rope_json(estimate.one_rope);
  json["readings"] = estimate.readings;
  json["left_out"] = Json::array();
  for (const LeftOut part : estimate.left_out) json["left_out"].push_back(name_of(part));
  json["mask_agreement"] = number(estimate.mask_agreement);
  json["prior_mask_agreement"] = number(estimate.prior_mask_agreement);
  json["draws"] = draws_json(estimate.draws);
  json["reversed"] = estimate.reversed;
  json["switched"] = estimate.switched;
  json["nodes_m"] = nodes_json(estimate.nodes);
  json["support"] = estimate.support;
  json["sigma_m"] = Json::array();
  for (const float sigma_m : estimate.sigma_m) json["sigma_m"].push_back(number(sigma_m));
  json["alternatives"] = alternatives_json(estimate.alternatives);
  json["timings_ms"] = timings_json(estimate.timings);
  json["device_timings_ms"] = device_timings_json(estimate.timings);
  return json;
}

// Those of one rope with others and with itself, in order along it.
Json crossings_json(const Ropes& ropes, int rope) {
  std::vector<std::pair<float, Json>> found;
  for (const RopeCrossing& crossing : ropes.crossings) {
    for (const bool over : {true, false}) {
      if ((over ? crossing.over : crossing.under) != rope) continue;
      const float at_m = over ? crossing.over_at_m : crossing.under_at_m;
      found.emplace_back(
          at_m, Json{{"rope", over ? crossing.under : crossing.over},
                     {"at_m", number(at_m)},
                     {"other_at_m", number(over ? crossing.under_at_m : crossing.over_at_m)},
                     {"over", over},
                     {"apart_m", number(crossing.apart_m)}});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Json list = Json::array();
  for (auto& [at_m, crossing] : found) list.push_back(std::move(crossing));
  return list;
}

Json rope_json(const Ropes& ropes, std::size_t index) {
  const Estimate& rope = ropes.ropes[index];
  Json nodes = Json::array();
  for (const Point3& node : rope.nodes) nodes.push_back(numbers(node));
  Json sigma_m = Json::array();
  for (const float sigma : rope.sigma_m) sigma_m.push_back(number(sigma));
  return {{"nodes", std::move(nodes)},
          {"closed", rope.closed},
          {"source", name_of(rope.source)},
          {"origin", name_of(rope.origin)},
          {"support", rope.support},
          {"sigma_m", std::move(sigma_m)},
          {"confidence", number(rope.confidence)},
          {"one_rope", one_rope_json(rope.one_rope)},
          {"mask_agreement", number(rope.mask_agreement)},
          {"crossings", crossings_json(ropes, static_cast<int>(index))}};
}

}  // namespace

std::string estimate_json(const Estimate& estimate, const Provenance& provenance) {
  return text_of(whole_json(estimate, provenance));
}

std::string ropes_json(const TrackedRopes& tracked, const Provenance& provenance) {
  const Ropes& ropes = tracked.found;
  Json json = whole_json(ropes.ropes.front(), provenance);
  json["ropes"] = Json::array();
  for (std::size_t i = 0; i < ropes.ropes.size(); ++i) {
    json["ropes"].push_back(rope_json(ropes, i));
    if (!tracked.numbers.empty()) json["ropes"].back()["number"] = tracked.numbers[i];
  }
  if (!tracked.numbers.empty()) json["missing"] = tracked.missing;
  json["parting_ms"] = number(ropes.parting_ms);
  json["ropes_ms"] = number(ropes.total_ms);
  return text_of(json);
}

std::string failure_json(const Error& error, const Provenance& provenance) {
  return text_of(header(name_of(error.code), error.message, provenance));
}

}  // namespace flowdlo::tools
