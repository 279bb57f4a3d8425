#include "eval/drawn_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "flowdlo/frame_folder.hpp"
#include "pictures/canvas.hpp"

namespace flowdlo::eval {
namespace {

constexpr std::size_t kMostFrames = 6;
constexpr int kSide = 360;
constexpr int kTop = 54;
constexpr float kFarthest_px = 1e5F;

// A square cut of the image around its mask, as large as a panel.
struct Cut {
  cv::Mat picture;
  cv::Point2f offset;
  float zoom = 1;
};

Cut cut_of(const FrameFolder& folder) {
  cv::Mat mask(folder.height, folder.width, CV_8U);
  std::copy(folder.mask.begin(), folder.mask.end(), mask.data);
  cv::Mat image(folder.height, folder.width, CV_8UC3, cv::Scalar::all(120));
  if (!folder.color_bgr.empty()) {
    std::copy(folder.color_bgr.begin(), folder.color_bgr.end(), image.data);
  }
  cv::Rect box = cv::boundingRect(mask > 127);
  if (box.empty()) box = {0, 0, folder.width, folder.height};
  const int side = std::max(box.width, box.height) + 80;
  const cv::Point corner(box.x + box.width / 2 - side / 2, box.y + box.height / 2 - side / 2);
  cv::Mat square(side, side, CV_8UC3, cv::Scalar::all(255));
  const cv::Rect inside = cv::Rect(corner, cv::Size(side, side)) & cv::Rect({0, 0}, image.size());
  image(inside).copyTo(square(inside - corner));
  Cut cut;
  cv::resize(square, cut.picture, {kSide, kSide}, 0, 0, cv::INTER_AREA);
  cut.picture = 0.55 * cut.picture + cv::Scalar::all(110);
  cut.offset = corner;
  cut.zoom = static_cast<float>(kSide) / static_cast<float>(side);
  return cut;
}

void draw(const Centerline& nodes, const Intrinsics& camera, const Cut& cut,
          const cv::Scalar& color, int width, cv::Mat& panel) {
  std::vector<cv::Point> line;
  for (const Point3& node : nodes) {
    if (!(node.z > 0)) continue;
    const auto pixel = [&](float value) {
      return static_cast<int>(
          std::lround(std::clamp(value * cut.zoom, -kFarthest_px, kFarthest_px)));
    };
    line.emplace_back(pixel(camera.fx * node.x / node.z + camera.cx - cut.offset.x),
                      pixel(camera.fy * node.y / node.z + camera.cy - cut.offset.y));
  }
  if (line.empty()) return;
  cv::polylines(panel, line, false, color, width, cv::LINE_AA);
  cv::circle(panel, line.front(), 5, color, 2, cv::LINE_AA);
}

void draw_frame(const Trial& trial, const FrameFolder& folder, int y, pictures::Canvas& canvas) {
  const Cut cut = cut_of(folder);
  for (int column = 0; column < 3; ++column) {
    cv::Mat panel = canvas.panel({10 + column * (kSide + 10), y + 20, kSide, kSide});
    cut.picture.copyTo(panel);
    const auto all = [&](const char* method, const cv::Scalar* color, int width) {
      const auto found = trial.curves.find(method);
      if (found == trial.curves.end()) return;
      for (std::size_t d = 0; d < found->second.size(); ++d) {
        draw(found->second[d], folder.intrinsics, cut,
             color == nullptr ? pictures::draw_color(d) : *color, width, panel);
      }
    };
    if (column == 0) {
      all("model", nullptr, 1);
      all("prior", &pictures::kPriorColor, 3);
    } else if (column == 1 && trial.answered()) {
      draw(trial.nodes, folder.intrinsics, cut, pictures::kEstimateColor, 2, panel);
    } else if (column == 2) {
      all("trackdlo", &pictures::kBaselineColor, 2);
    }
  }
  const Account* baseline = trial.account("trackdlo");
  canvas.write(
      fmt::format("{}: {} of {} draws accepted, mask consistency {:.1f} %, confidence {:.2f}; "
                  "TrackDLO-init {}",
                  trial.name, trial.accepted_draws, trial.draws, 100 * trial.mask_agreement,
                  trial.confidence,
                  baseline == nullptr ? "not run"
                  : baseline->valid() ? fmt::format("{:.1f} %", 100 * baseline->mask_agreement)
                                      : baseline->failure),
      {10, y + 14});
}

}  // namespace

Png real_overlay_png(const DataSet& data_set) {
  std::vector<std::pair<const Trial*, FrameFolder>> frames;
  for (const Trial* trial : data_set.trials) {
    if (trial->with_truth || frames.size() == kMostFrames) continue;
    auto folder = load_frame_folder(trial->folder);
    if (folder) frames.emplace_back(trial, *std::move(folder));
  }
  if (frames.empty()) return std::vector<std::uint8_t>();
  pictures::Canvas canvas(20 + 3 * (kSide + 10),
                          kTop + (kSide + 30) * static_cast<int>(frames.size()));
  canvas.legend(pictures::legend_of_draws("prior", pictures::kPriorColor), {10, 24});
  int y = kTop - 10;
  for (const auto& [trial, folder] : frames) {
    draw_frame(*trial, folder, y, canvas);
    y += kSide + 30;
  }
  return canvas.png();
}

}  // namespace flowdlo::eval
