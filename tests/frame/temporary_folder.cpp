#include "frame/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "frame/png.hpp"

namespace flowdlo::test {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("flowdlo_") + test->test_suite_name() + "_" + test->name() + "_" +
                     std::to_string(::getpid());
  for (auto& character : name) {
    if (character == '/') character = '_';
  }
  path_ = fs::temp_directory_path() / name;
  fs::remove_all(path_);
  fs::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void write_text(const fs::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
}

// OpenCV's own writer brings 120 libraries, which take 0.15 s of each test's start.
void write_png(const fs::path& file, const cv::Mat& image) {
  const auto png = frame::encode_png(
      {image.cols, image.rows, image.channels(), image.depth() == CV_16U ? 16 : 8}, image.data,
      image.step);
  ASSERT_TRUE(png) << png.error().message;
  write_text(file, {reinterpret_cast<const char*>(png->data()), png->size()});
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string camera_text(const std::string& fx) {
  return "{\"width\": 80, \"height\": 60, \"fx\": " + fx +
         ", \"fy\": 100, \"cx\": 39.5, \"cy\": 29.5, \"depth_scale\": 0.001}";
}

fs::path write_frame(const fs::path& parent, const std::string& name) {
  const fs::path folder = parent / name;
  fs::create_directories(folder);
  const cv::Rect rope(10, 28, 60, 5);
  cv::Mat depth(60, 80, CV_16UC1, cv::Scalar(600));
  cv::Mat mask(60, 80, CV_8UC1, cv::Scalar(0));
  depth(rope) = 500;
  mask(rope) = 255;
  write_png(folder / "depth.png", depth);
  write_png(folder / "mask.png", mask);
  write_png(folder / "color.png", cv::Mat(60, 80, CV_8UC3, cv::Scalar(10, 20, 30)));
  write_text(folder / "camera.json", camera_text());
  return folder;
}

}  // namespace flowdlo::test
