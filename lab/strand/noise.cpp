#include "strand/noise.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace flowdlo::strand {

cv::Mat smooth_noise(int size_px, double cell_px, Dice& dice) {
  const int cells = std::max(2, static_cast<int>(size_px / cell_px));
  cv::Mat coarse(cells, cells, CV_32F);
  for (int i = 0; i < cells * cells; ++i) coarse.ptr<float>()[i] = dice.gaussian();
  cv::Mat fine;
  cv::resize(coarse, fine, {size_px, size_px}, 0, 0, cv::INTER_CUBIC);
  return fine;
}

void add_noise(cv::Mat& image, float deviation, Dice& dice) {
  cv::RNG random(dice.word());
  cv::Mat noise(image.size(), image.type());
  random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0),
              cv::Scalar::all(static_cast<double>(deviation)));
  image += noise;
}

void add_camera_noise(cv::Mat& image, float levels, float pixel_px, Dice& dice) {
  const int side =
      std::max(2, static_cast<int>(static_cast<float>(image.cols) / std::max(1.0F, pixel_px)));
  cv::Mat coarse = cv::Mat::zeros(side, side, image.type());
  add_noise(coarse, levels / 255, dice);
  cv::Mat fine;
  cv::resize(coarse, fine, image.size(), 0, 0, cv::INTER_LINEAR);
  image += fine;
}

}  // namespace flowdlo::strand
