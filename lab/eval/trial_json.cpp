#include "eval/trial_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "eval/draws.hpp"

namespace flowdlo::eval {
namespace {

using nlohmann::json;

// JSON has no NaN: it is written as null.
double number_of(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

float coordinate_of(const json& value) { return static_cast<float>(number_of(value)); }

json numbers_of(const Centerline& nodes) {
  json values = json::array();
  for (const Point3& node : nodes) {
    for (const float value : {node.x, node.y, node.z}) values.push_back(value);
  }
  return values;
}

Centerline centerline_of(const json& values) {
  Centerline nodes{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    nodes[i] = {coordinate_of(values.at(3 * i)), coordinate_of(values.at(3 * i + 1)),
                coordinate_of(values.at(3 * i + 2))};
  }
  return nodes;
}

json scene_json(const SceneInfo& scene) {
  return {{"scenario", scene.scenario},
          {"material", scene.material},
          {"defects", scene.defects},
          {"described", scene.described},
          {"crossings", scene.crossings}};
}

SceneInfo scene_of(const json& value) {
  SceneInfo scene;
  scene.scenario = value.at("scenario").get<std::string>();
  scene.material = value.at("material").get<std::string>();
  scene.defects = value.at("defects").get<std::set<std::string>>();
  scene.described = value.at("described").get<bool>();
  scene.crossings = value.at("crossings").get<int>();
  return scene;
}

json methods_json(const std::map<std::string, Outcome>& methods) {
  json values = json::object();
  for (const auto& [name, outcome] : methods) {
    values[name] = {outcome.index_m, outcome.frechet_m, outcome.either_index_m,
                    outcome.strand_errors, outcome.flips};
  }
  return values;
}

std::map<std::string, Outcome> methods_of(const json& value) {
  std::map<std::string, Outcome> methods;
  for (const auto& [name, numbers] : value.items()) {
    methods[name] = {number_of(numbers.at(0)), number_of(numbers.at(1)), number_of(numbers.at(2)),
                     number_of(numbers.at(3)), number_of(numbers.at(4))};
  }
  return methods;
}

json accounts_json(const std::map<std::string, Account>& accounts) {
  json values = json::object();
  for (const auto& [name, account] : accounts) {
    values[name] = {account.failure, account.output, account.draws, account.accepted,
                    account.mask_agreement};
  }
  return values;
}

std::map<std::string, Account> accounts_of(const json& value) {
  std::map<std::string, Account> accounts;
  for (const auto& [name, fields] : value.items()) {
    accounts[name] = {fields.at(0).get<std::string>(), fields.at(1).get<bool>(),
                      fields.at(2).get<int>(), fields.at(3).get<int>(), number_of(fields.at(4))};
  }
  return accounts;
}

// Whole numbers of kCurveUnit_m: curves were rounded to it.
json curves_json(const std::map<std::string, std::vector<Centerline>>& curves) {
  json values = json::object();
  for (const auto& [name, draws] : curves) {
    json& lines = values[name] = json::array();
    for (const Centerline& nodes : draws) {
      json line = json::array();
      for (const Point3& node : nodes) {
        for (const float v : {node.x, node.y, node.z}) {
          line.push_back(std::llround(static_cast<double>(v) / kCurveUnit_m));
        }
      }
      lines.push_back(std::move(line));
    }
  }
  return values;
}

std::map<std::string, std::vector<Centerline>> curves_of(const json& value) {
  std::map<std::string, std::vector<Centerline>> curves;
  const auto metres = [](const json& number) {
    return static_cast<float>(static_cast<double>(number.get<long long>()) * kCurveUnit_m);
  };
  for (const auto& [name, lines] : value.items()) {
    auto& draws = curves[name];
    for (const json& line : lines) {
      Centerline nodes{};
      for (std::size_t i = 0; i < kNodes; ++i) {
        nodes[i] = {metres(line.at(3 * i)), metres(line.at(3 * i + 1)), metres(line.at(3 * i + 2))};
      }
      draws.push_back(nodes);
    }
  }
  return curves;
}

Trial trial_of(const json& value) {
  Trial trial;
  trial.name = value.at("name").get<std::string>();
  trial.folder = value.at("folder").get<std::string>();
  trial.data_set = value.at("data_set").get<std::string>();
  trial.scene = scene_of(value.at("scene"));
  trial.failure = value.at("failure").get<std::string>();
  trial.with_truth = value.at("with_truth").get<bool>();
  trial.methods = methods_of(value.at("methods"));
  trial.accounts = accounts_of(value.at("accounts"));
  trial.curves = curves_of(value.at("curves"));
  trial.nodes = centerline_of(value.at("nodes"));
  trial.truth = centerline_of(value.at("truth"));
  trial.source = value.at("source") == "prediction" ? Source::kPrediction : Source::kPrior;
  trial.accepted_draws = value.at("accepted_draws").get<int>();
  trial.draws = value.at("draws").get<int>();
  trial.confidence = number_of(value.at("confidence"));
  trial.mask_agreement = number_of(value.at("mask_agreement"));
  trial.total_ms = number_of(value.at("total_ms"));
  trial.sigma = {number_of(value.at("sigma").at(0)), number_of(value.at("sigma").at(1))};
  return trial;
}

}  // namespace

std::string row_json(const Row& row) {
  const Trial& trial = row.trial;
  return json{{"row", row.index},
              {"name", trial.name},
              {"folder", trial.folder.string()},
              {"data_set", trial.data_set},
              {"scene", scene_json(trial.scene)},
              {"failure", trial.failure},
              {"with_truth", trial.with_truth},
              {"methods", methods_json(trial.methods)},
              {"accounts", accounts_json(trial.accounts)},
              {"curves", curves_json(trial.curves)},
              {"nodes", numbers_of(trial.nodes)},
              {"truth", numbers_of(trial.truth)},
              {"source", trial.source == Source::kPrediction ? "prediction" : "prior"},
              {"accepted_draws", trial.accepted_draws},
              {"draws", trial.draws},
              {"confidence", trial.confidence},
              {"mask_agreement", trial.mask_agreement},
              {"total_ms", trial.total_ms},
              {"sigma", {trial.sigma.one, trial.sigma.two}}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<Row> parse_row(std::string_view line, const std::string& who) {
  const json found = json::parse(line, nullptr, false);
  try {
    return Row{found.at("row").get<std::size_t>(), trial_of(found)};
  } catch (const json::exception& fault) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected a row of flowdlo eval, got something else ({}); remove "
                             "the file and evaluate again",
                             who, fault.what())};
  }
}

}  // namespace flowdlo::eval
