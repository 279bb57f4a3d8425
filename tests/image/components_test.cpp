// Pieces, their numbers, areas and boxes are those of OpenCV.
#include "image/components.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

class Pieces : public testing::TestWithParam<Neighbours> {};

TEST_P(Pieces, AreThoseOfOpenCv) {
  const int neighbours = GetParam() == Neighbours::kFour ? 4 : 8;
  for (std::uint64_t number = 0; number < 210; ++number) {
    const cv::Mat mask = some_mask(number);
    cv::Mat labels;
    cv::Mat stats;
    cv::Mat centroids;
    const int count =
        cv::connectedComponentsWithStats(mask, labels, stats, centroids, neighbours, CV_32S);
    const Components own = components(mat::image_of<std::uint8_t>(mask), GetParam());
    ASSERT_EQ(own.count(), count) << number;
    ASSERT_TRUE(same_bits(mat::mat_over(own.labels), labels)) << number;
    for (int i = 0; i < count; ++i) {
      const Component& piece = own.pieces[static_cast<std::size_t>(i)];
      ASSERT_EQ(piece.area, stats.at<int>(i, cv::CC_STAT_AREA)) << number;
      if (i == 0) continue;
      const Rect box{stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                     stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)};
      ASSERT_EQ(piece.box, box) << number;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Pieces, testing::Values(Neighbours::kFour, Neighbours::kEight));

TEST(Pieces, OfNothingAreWhatIsEmptyAlone) {
  EXPECT_EQ(components(Mask(), Neighbours::kEight).count(), 1);
}

TEST(SetPieces, EachPieceGetsItsValue) {
  Mask mask({9, 6}, 0);
  for (const auto& [v, u] : {std::pair{1, 1}, {1, 2}, {2, 3}, {4, 6}, {4, 8}}) mask.at(v, u) = 1;
  const Components own = components(mask, Neighbours::kEight);
  ASSERT_EQ(own.count(), 4);
  std::vector<std::uint8_t> values(own.pieces.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(7 * i + 3);
  Mask set = mask.clone();
  set_pieces(own.labels, values, set);
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      ASSERT_EQ(set.at(v, u), values[static_cast<std::size_t>(own.labels.at(v, u))]);
    }
  }
}

}  // namespace
}  // namespace flowdlo::image
