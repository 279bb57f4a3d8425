// Program: the flowdlo command, run as a user would run it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace flowdlo::test {

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

/// Runs `flowdlo` with `arguments`; what it prints goes through files in `scratch`.
[[nodiscard]] Outcome run_flowdlo(const std::filesystem::path& scratch,
                                  const std::vector<std::string>& arguments);

/// The same of another program.
[[nodiscard]] Outcome run_program(const std::filesystem::path& scratch,
                                  const std::filesystem::path& program,
                                  const std::vector<std::string>& arguments);

/// `estimate` on the CPU with the weights that ship, one draw and one step: quick.
[[nodiscard]] Outcome run_estimate(const std::filesystem::path& scratch,
                                   std::vector<std::string> arguments);

/// Where run_estimate puts its results.
[[nodiscard]] std::filesystem::path results(const std::filesystem::path& scratch,
                                            const std::string& frame);

/// The frame's estimate.json; null when there is none or it is not JSON.
[[nodiscard]] nlohmann::json estimate_json_of(const std::filesystem::path& scratch,
                                              const std::string& frame);

}  // namespace flowdlo::test
