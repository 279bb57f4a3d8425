#include "pictures/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "durability_choice.hpp"
#include "mat/mat_file.hpp"

namespace flowdlo::pictures {
namespace {

constexpr int kWidth_px = 300;  // of one picture
constexpr int kHeight_px = 225;
constexpr int kText_px = 34;
constexpr int kColumns = 2;  // frames side by side

cv::Mat fitted(const cv::Mat& image) {
  const double scale = std::min(static_cast<double>(kWidth_px) / image.cols,
                                static_cast<double>(kHeight_px) / image.rows);
  cv::Mat small;
  cv::resize(image, small, cv::Size(), scale, scale, cv::INTER_AREA);
  cv::Mat canvas(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar(60, 60, 60));
  small.copyTo(canvas(cv::Rect(0, 0, small.cols, small.rows)));
  return canvas;
}

// Near is red, far is blue, between the nearest and the farthest of the rope's surroundings.
cv::Mat depth_picture(const FrameFolder& folder) {
  float nearest = 1e9F;
  float farthest = 0;
  for (const Point3& node : *folder.truth) {
    nearest = std::min(nearest, node.z - 0.03F);
    farthest = std::max(farthest, node.z + 0.06F);
  }
  cv::Mat shown(folder.height, folder.width, CV_8UC1);
  cv::Mat none(folder.height, folder.width, CV_8UC1);
  for (std::size_t i = 0; i < folder.depth_m.size(); ++i) {
    const float share = (folder.depth_m[i] - nearest) / (farthest - nearest);
    shown.data[i] = static_cast<std::uint8_t>(255 * (1 - std::clamp(share, 0.0F, 1.0F)));
    none.data[i] = folder.depth_m[i] > 0 ? 0 : 255;
  }
  cv::Mat picture;
  cv::applyColorMap(shown, picture, cv::COLORMAP_JET);
  picture.setTo(cv::Scalar(0, 0, 0), none);
  return picture;
}

cv::Mat color_picture(const FrameFolder& folder) {
  cv::Mat picture(folder.height, folder.width, CV_8UC3, cv::Scalar(90, 90, 90));
  std::copy(folder.color_bgr.begin(), folder.color_bgr.end(), picture.data);
  const int thickness = std::max(1, folder.width / 480);
  std::vector<cv::Point> curve;
  for (const Point3& node : *folder.truth) {
    curve.emplace_back(
        static_cast<int>(folder.intrinsics.fx * node.x / node.z + folder.intrinsics.cx),
        static_cast<int>(folder.intrinsics.fy * node.y / node.z + folder.intrinsics.cy));
  }
  cv::polylines(picture, curve, false, cv::Scalar(255, 255, 255), thickness, cv::LINE_AA);
  cv::circle(picture, curve.front(), 4 * thickness, cv::Scalar(0, 255, 255), cv::FILLED);
  cv::circle(picture, curve.back(), 4 * thickness, cv::Scalar(255, 0, 255), cv::FILLED);
  return picture;
}

cv::Mat mask_picture(const FrameFolder& folder) {
  cv::Mat picture(folder.height, folder.width, CV_8UC1);
  std::copy(folder.mask.begin(), folder.mask.end(), picture.data);
  cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

std::string defects_text(const synth::Defects& defects) {
  std::string text;
  const auto add = [&](bool present, const char* name) {
    if (present) text += fmt::format(" {}", name);
  };
  add(defects.gap, "gap");
  add(defects.hidden_end, "hidden_end");
  add(defects.outside, "outside");
  add(defects.touch, "touch");
  add(defects.depth_holes, "holes");
  add(defects.depth_turn, "turn");
  add(defects.black_or_shiny, "black");
  add(defects.flying_pixels, "flying");
  add(defects.edge_dropout, "dropout");
  add(defects.mask_ragged, "ragged");
  add(defects.mask_specks, "specks");
  add(defects.mask_gaps, "cuts");
  add(defects.mask_shifted, "shifted");
  return text;
}

cv::Mat cell_of(const synth::SyntheticFrame& frame) {
  const synth::Meta& meta = frame.meta;
  cv::Mat cell(kHeight_px + kText_px, 3 * kWidth_px + 6, CV_8UC3, cv::Scalar(0, 0, 0));
  const std::vector<cv::Mat> pictures = {color_picture(frame.folder), depth_picture(frame.folder),
                                         mask_picture(frame.folder)};
  for (int k = 0; k < 3; ++k) {
    fitted(pictures[static_cast<std::size_t>(k)])
        .copyTo(cell(cv::Rect(k * kWidth_px, kText_px, kWidth_px, kHeight_px)));
  }
  const auto write = [&](const std::string& text, int y) {
    cv::putText(cell, text, {4, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(255, 255, 255), 1,
                cv::LINE_AA);
  };
  write(fmt::format("{} {} {} | r {:.1f} mm L {:.2f} m X {} | {} {:.2f} m {:.0f} deg", meta.index,
                    meta.scenario, meta.material, 1000 * meta.radius_m, meta.length_m,
                    meta.crossings, meta.camera, meta.distance_m, meta.tilt_deg),
        13);
  write(fmt::format("{}{}",
                    meta.hard()   ? "HARD"
                    : meta.easy() ? "easy"
                                  : "",
                    defects_text(meta.defects)),
        29);
  return cell;
}

}  // namespace

Result<void> save_contact_sheet(const std::filesystem::path& file,
                                std::span<const synth::SyntheticFrame> frames) {
  const int rows = (static_cast<int>(frames.size()) + kColumns - 1) / kColumns;
  const cv::Size cell(3 * kWidth_px + 6, kHeight_px + kText_px);
  cv::Mat sheet(std::max(1, rows) * cell.height, kColumns * cell.width, CV_8UC3,
                cv::Scalar(0, 0, 0));
  for (int k = 0; k < static_cast<int>(frames.size()); ++k) {
    const cv::Point corner(k % kColumns * cell.width, k / kColumns * cell.height);
    cell_of(frames[static_cast<std::size_t>(k)]).copyTo(sheet(cv::Rect(corner, cell)));
  }
  return mat::save_png(file, sheet, support::chosen_durability());
}

}  // namespace flowdlo::pictures
