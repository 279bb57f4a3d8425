#include "eval/method_rows.hpp"

#include <fmt/format.h>

#include <set>

namespace flowdlo::eval {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"') result += '"';
    result += letter;
  }
  return result + "\"";
}

std::string method_rows_csv(std::span<const Trial> trials) {
  std::string out =
      "data_set,frame,scenario,method,output,valid,reason,draws,accepted,mask_agreement,"
      "index_cm,frechet_cm,either_cm,flips,strand_errors\n";
  for (const Trial& trial : trials) {
    std::set<std::string> methods;
    for (const auto& [name, account] : trial.accounts) methods.insert(name);
    for (const auto& [name, outcome] : trial.methods) methods.insert(name);
    for (const std::string& method : methods) {
      out += fmt::format("{},{},{},{}", csv_field(trial.data_set), csv_field(trial.name),
                         csv_field(trial.scene.scenario), csv_field(method));
      if (const Account* account = trial.account(method)) {
        out += fmt::format(",{:d},{:d},{},{},{},{:.4f}", account->output, account->valid(),
                           csv_field(account->failure), account->draws, account->accepted,
                           account->mask_agreement);
      } else {
        out += ",1,1,,,,";
      }
      if (const Outcome* outcome = trial.of(method)) {
        out += fmt::format(",{:.5f},{:.5f},{:.5f},{:.4f},{:.4f}\n", 100 * outcome->index_m,
                           100 * outcome->frechet_m, 100 * outcome->either_index_m, outcome->flips,
                           outcome->strand_errors);
      } else {
        out += ",,,,,\n";
      }
    }
  }
  return out;
}

}  // namespace flowdlo::eval
