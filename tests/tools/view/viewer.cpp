#include "tools/view/viewer.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>

#include "frame/temporary_folder.hpp"
#include "tools/view/http_client.hpp"

namespace flowdlo::test {

namespace fs = std::filesystem;

Viewer::Viewer(const fs::path& scratch, const std::vector<std::string>& more) {
  std::vector<std::string> all = {FLOWDLO_COMMAND,   "view",
                                  "--device",        "cpu",
                                  "--draws",         "2",
                                  "--steps",         "1",
                                  "--weights",       FLOWDLO_WEIGHTS,
                                  "--field-weights", FLOWDLO_FIELD_WEIGHTS};
  all.insert(all.end(), more.begin(), more.end());
  std::vector<char*> arguments;
  for (auto& argument : all) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2");
  const std::string words = scratch / "view.txt";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, words.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int fault =
      ::posix_spawn(&process_, FLOWDLO_COMMAND, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  for (char letter = 0; fault == 0 && ::read(ends[0], &letter, 1) == 1 && letter != '\n';) {
    url_ += letter;
  }
  ::close(ends[0]);
  const auto colon = url_.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error("no link: " + read_text(words));
  port_ = std::stoi(url_.substr(colon + 1));
  base_ = url_.substr(url_.find('/', colon));
}

Viewer::~Viewer() {
  if (process_ > 0) end(SIGKILL);
}

int Viewer::end(int signal) {
  ::kill(process_, signal);
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string Viewer::get(const std::string& part) const { return fetched(port_, base_ + part); }

}  // namespace flowdlo::test
