// A folder that lives as long as its test, and small frame folders in it to break.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

namespace flowdlo::test {

class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void write_text(const std::filesystem::path& file, std::string_view text);
void write_png(const std::filesystem::path& file, const cv::Mat& image);
[[nodiscard]] std::string read_text(const std::filesystem::path& file);

/// A whole frame folder `parent/name`: 80 x 60 px, a horizontal rope of 5 px at 0.5 m from column
/// 10 to 69 before a table at 0.6 m, depth in millimetres, own camera.json.
std::filesystem::path write_frame(const std::filesystem::path& parent,
                                  const std::string& name = "rope");

/// camera.json in our own form for that frame, with `fx` as written.
[[nodiscard]] std::string camera_text(const std::string& fx = "100");

}  // namespace flowdlo::test
