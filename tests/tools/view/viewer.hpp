// Viewer: flowdlo view as a program that runs beside the test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace flowdlo::test {

class Viewer {
 public:
  /// `flowdlo view` with two draws of one step on the CPU, and `more` arguments. Throws where it
  /// prints no link; what it says goes to a file in `scratch`.
  Viewer(const std::filesystem::path& scratch, const std::vector<std::string>& more);
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer();

  /// The exit code; -1: the signal ended it.
  int end(int signal);

  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] int port() const { return port_; }
  /// The whole answer to a GET of a part of the page.
  [[nodiscard]] std::string get(const std::string& part) const;

 private:
  pid_t process_ = -1;
  std::string url_;
  std::string base_;  // the path of the page, its secret
  int port_ = 0;
};

}  // namespace flowdlo::test
