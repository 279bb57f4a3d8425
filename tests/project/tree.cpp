#include "project/tree.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "project/command.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::project {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = test::source_dir();

std::vector<std::string> files_known_to_git() {
  const auto listed =
      run("test \"$(git -c safe.directory='*' rev-parse --show-toplevel)\" -ef . && "
          "git -c safe.directory='*' ls-files --cached --others --exclude-standard");
  return listed.status == 0 ? lines_of(listed.output) : std::vector<std::string>{};
}

std::vector<std::string> files_on_disk() {
  std::vector<std::string> files;
  for (auto it = fs::recursive_directory_iterator(kRoot); it != fs::end(it); ++it) {
    const auto path = it->path().lexically_relative(kRoot).generic_string();
    const bool left_by_a_build = path == "build" || path == "out" || path == ".cache";
    if (it->is_directory() && (left_by_a_build || path == ".git")) {
      it.disable_recursion_pending();
    } else if (it->is_regular_file()) {
      files.push_back(path);
    }
  }
  return files;
}

}  // namespace

std::vector<std::string> lines_of(std::string_view content) {
  std::istringstream stream{std::string(content)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

bool is_text(std::string_view content) { return content.find('\0') == std::string_view::npos; }

std::string read(const std::string& path) {
  std::ifstream file(kRoot / path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> project_files() {
  auto files = files_known_to_git();
  if (files.empty()) {
    files = files_on_disk();
  }
  std::erase_if(files, [](const std::string& path) { return !fs::is_regular_file(kRoot / path); });
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace flowdlo::project
