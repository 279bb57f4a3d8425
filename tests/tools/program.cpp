#include "tools/program.hpp"

#include <sys/wait.h>

#include <cstdlib>

#include "frame/temporary_folder.hpp"

namespace flowdlo::test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char character : text) {
    if (character == '\'') {
      result += "'\\''";
    } else {
      result += character;
    }
  }
  return result + "'";
}

}  // namespace

Outcome run_program(const fs::path& scratch, const fs::path& program,
                    const std::vector<std::string>& arguments) {
  const auto out = scratch / "stdout.txt";
  const auto err = scratch / "stderr.txt";
  std::string line = quoted(program.string());
  for (const auto& argument : arguments) line.append(" ").append(quoted(argument));
  line.append(" > ").append(quoted(out.string()));
  line.append(" 2> ").append(quoted(err.string()));
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

Outcome run_flowdlo(const fs::path& scratch, const std::vector<std::string>& arguments) {
  return run_program(scratch, FLOWDLO_COMMAND, arguments);
}

Outcome run_estimate(const fs::path& scratch, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "estimate");
  const std::vector<std::string> quick = {"--out",     (scratch / "out").string(),
                                          "--device",  "cpu",
                                          "--draws",   "1",
                                          "--steps",   "1",
                                          "--weights", FLOWDLO_WEIGHTS};
  arguments.insert(arguments.end(), quick.begin(), quick.end());
  return run_flowdlo(scratch, arguments);
}

fs::path results(const fs::path& scratch, const std::string& frame) {
  return scratch / "out" / frame;
}

nlohmann::json estimate_json_of(const fs::path& scratch, const std::string& frame) {
  const auto text = read_text(results(scratch, frame) / "estimate.json");
  return nlohmann::json::accept(text) ? nlohmann::json::parse(text) : nlohmann::json();
}

}  // namespace flowdlo::test
