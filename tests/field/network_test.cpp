#include "field/network.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "field/sight.hpp"
#include "mat/mat_image.hpp"
#include "reference/program.hpp"
#include "support/faulty_program.hpp"

namespace flowdlo::field {
namespace {

using weights::FieldSizes;
using weights::FieldWeights;

std::shared_ptr<const FieldWeights> noise(const FieldSizes& sizes = {16, 32, 48}) {
  return std::make_shared<const FieldWeights>(weights::seeded_field(sizes, 5));
}

Network network_of(std::shared_ptr<const FieldWeights> weights, int threads = 1) {
  auto made =
      Network::create(std::move(weights), [threads] { return reference::create_program(threads); });
  if (!made) throw std::runtime_error(made.error().message);
  return *std::move(made);
}

Planes random_input(int width, int height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(-1, 1);
  Planes input({width, height});
  for (std::size_t i = 0; i < input.total(); ++i) {
    for (float& plane : input.data()[i]) plane = value(random);
  }
  return input;
}

/// All blocks of a region.
BlockMap everything(const Planes& input) {
  return blocks_near(image::Image<float>(input.size(), 1.0F));
}

// -- The network once more, plainly, in double ----------------------------------------------------

struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<double> values;

  Image(int w, int h, int c)
      : width(w), height(h), channels(c), values(static_cast<std::size_t>(w * h * c)) {}
  double& at(int u, int v, int c) {
    return values[static_cast<std::size_t>((v * width + u) * channels + c)];
  }
  [[nodiscard]] double get(int u, int v, int c) const {
    if (u < 0 || v < 0 || u >= width || v >= height) return 0;
    return values[static_cast<std::size_t>((v * width + u) * channels + c)];
  }
};

Image convolved(const FieldWeights& weights, const std::string& name, const Image& x, bool relu) {
  const weights::Tensor& weight = weights.at(name + ".weight");
  const weights::Tensor& bias = weights.at(name + ".bias");
  const int out = weight.shape[0];
  const int taps = weight.shape[1];
  const int in = weight.shape[2];
  Image y(x.width, x.height, out);
  for (int v = 0; v < x.height; ++v) {
    for (int u = 0; u < x.width; ++u) {
      for (int o = 0; o < out; ++o) {
        double sum = static_cast<double>(bias.values[static_cast<std::size_t>(o)]);
        for (int tap = 0; tap < taps; ++tap) {
          const int du = taps == 1 ? 0 : tap % 3 - 1;
          const int dv = taps == 1 ? 0 : tap / 3 - 1;
          for (int i = 0; i < in; ++i) {
            sum += x.get(u + du, v + dv, i) *
                   static_cast<double>(
                       weight.values[static_cast<std::size_t>((o * taps + tap) * in + i)]);
          }
        }
        y.at(u, v, o) = relu ? std::max(0.0, sum) : sum;
      }
    }
  }
  return y;
}

Image pooled(const Image& x) {
  Image y(x.width / 2, x.height / 2, x.channels);
  for (int v = 0; v < y.height; ++v) {
    for (int u = 0; u < y.width; ++u) {
      for (int c = 0; c < y.channels; ++c) {
        y.at(u, v, c) =
            std::max(std::max(x.get(2 * u, 2 * v, c), x.get(2 * u + 1, 2 * v, c)),
                     std::max(x.get(2 * u, 2 * v + 1, c), x.get(2 * u + 1, 2 * v + 1, c)));
      }
    }
  }
  return y;
}

Image added(const Image& fine, const Image& coarse) {
  Image y = fine;
  for (int v = 0; v < y.height; ++v) {
    for (int u = 0; u < y.width; ++u) {
      for (int c = 0; c < y.channels; ++c) y.at(u, v, c) += coarse.get(u / 2, v / 2, c);
    }
  }
  return y;
}

/// Places of the finest level: 48 channels before any sigmoid.
Image plainly(const FieldWeights& w, const Planes& input) {
  Image x(input.width() / 2, input.height() / 2, weights::kFieldInputs);
  for (int v = 0; v < input.height(); ++v) {
    for (int u = 0; u < input.width(); ++u) {
      for (int c = 0; c < kPlanes; ++c) {
        x.at(u / 2, v / 2, 4 * c + 2 * (v % 2) + u % 2) = static_cast<double>(input.at(v, u)[c]);
      }
    }
  }
  const Image fine = convolved(w, "down_fine.1", convolved(w, "down_fine.0", x, true), true);
  const Image middle =
      convolved(w, "down_middle.1", convolved(w, "down_middle.0", pooled(fine), true), true);
  Image coarse = convolved(w, "coarse.0", pooled(middle), true);
  coarse = convolved(w, "coarse.2", convolved(w, "coarse.1", coarse, true), true);
  const Image half = added(middle, convolved(w, "to_middle", coarse, false));
  const Image up = convolved(w, "up_middle.1", convolved(w, "up_middle.0", half, true), true);
  const Image whole = added(fine, convolved(w, "to_fine", up, false));
  return convolved(w, "head",
                   convolved(w, "up_fine.1", convolved(w, "up_fine.0", whole, true), true), false);
}

/// The largest difference of any channel.
using Said = image::Image<std::array<float, kChannels>>;

double apart(const Said& a, const Said& b) {
  return cv::norm(mat::mat_over(a), mat::mat_over(b), cv::NORM_INF);
}
double apart(const Channels& a, const Channels& b) { return apart(a.whole(), b.whole()); }
double largest(const Said& a) { return cv::norm(mat::mat_over(a), cv::NORM_INF); }

double shown(int channel, double value) {
  const bool logit = channel == kCentre || channel == kTip || channel == kUnder ||
                     channel == kRope || channel == kEdge;
  return logit ? 1 / (1 + std::exp(-value)) : value;
}

TEST(Network, IsTheUNetThatItsWeightsSay) {
  const auto weights = noise();
  auto network = network_of(weights);
  const Planes input = random_input(96, 64);  // 3 x 2 blocks
  const auto field = network.see(input, everything(input));
  ASSERT_TRUE(field) << field.error().message;
  const Image expected = plainly(*weights, input);
  double most = 0;
  double worst = 0;
  for (int v = 0; v < input.height(); ++v) {
    for (int u = 0; u < input.width(); ++u) {
      for (int c = 0; c < kChannels; ++c) {
        const double want = shown(c, expected.get(u / 2, v / 2, 4 * c + 2 * (v % 2) + u % 2));
        most = std::max(most, std::abs(want));
        worst = std::max(worst, std::abs(want - static_cast<double>(field->at(v, u)[c])));
      }
    }
  }
  EXPECT_GT(most, 0.5);
  EXPECT_LT(worst / most, 1e-4);
}

TEST(Network, ThreadsChangeNoBit) {
  const Planes input = random_input(160, 128);
  const auto one = network_of(noise(), 1).see(input, everything(input));
  for (const int threads : {2, 3}) {
    const auto more = network_of(noise(), threads).see(input, everything(input));
    ASSERT_TRUE(one && more);
    EXPECT_EQ(apart(*one, *more), 0) << threads;
  }
}

TEST(Network, WhatIsFarFromTheMaskIsNoRope) {
  const Planes input = random_input(320, 64);
  image::Image<float> mask(input.size(), 0.0F);
  mask.at(10, 10) = 1;
  const auto field = network_of(noise()).see(input, blocks_near(mask));
  ASSERT_TRUE(field);
  EXPECT_EQ(largest(field->whole().part({128, 0, 192, 64})), 0);
  EXPECT_GT(largest(field->whole().part({0, 0, 32, 32})), 0.1);
}

TEST(Network, ALargerRegionMakesItGrowAndASmallerOneComesAsBefore) {
  auto network = network_of(noise());
  const Planes small = random_input(96, 64);
  const Planes large = random_input(416, 320);  // 130 blocks
  const auto before = network.see(small, everything(small));
  ASSERT_TRUE(network.see(large, everything(large)));
  const auto after = network.see(small, everything(small));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(apart(*before, *after), 0);
}

TEST(Network, SizesThatAreNoMultipleOfABlockAreSeenToTheirEnd) {
  const Planes input = random_input(75, 43);
  const auto field = network_of(noise()).see(input, everything(input));
  ASSERT_TRUE(field);
  EXPECT_EQ(field->size(), input.size());
  EXPECT_GT(largest(field->whole().part({74, 42, 1, 1})), 0);
}

TEST(Network, MoreThanFitsOneRunComesInPartsWithoutASeam) {
  auto network = network_of(noise({16, 16, 16}), 2);
  const Planes input = random_input(35 * kBlock_px, 33 * kBlock_px);  // 1155 blocks
  const auto field = network.see(input, everything(input));
  ASSERT_TRUE(field) << field.error().message;
  // Around the seam, seen in one run with all that matters around it.
  const image::Rect around{11 * kBlock_px, 4 * kBlock_px, 13 * kBlock_px, 12 * kBlock_px};
  const Planes part = input.part(around).clone();
  const auto alone = network.see(part, everything(part));
  ASSERT_TRUE(alone);
  const image::Rect inner{3 * kBlock_px, 3 * kBlock_px, 7 * kBlock_px, 6 * kBlock_px};
  // Tiles of a convolution round as what lies in them does, and part of it is beyond the halo.
  EXPECT_LT(apart(field->whole().part(around).part(inner), alone->whole().part(inner)), 1e-4);
}

ProgramFactory lost_after(int good_runs) {
  using testing::FaultyProgram;
  return [good_runs] {
    return std::make_unique<FaultyProgram>(FaultyProgram::Fault::kLost, good_runs);
  };
}

TEST(Network, ADeviceThatIsLostFails) {
  auto network = Network::create(noise(), lost_after(1));
  ASSERT_TRUE(network);
  const Planes input = random_input(96, 64);
  EXPECT_TRUE(network->see(input, everything(input)));
  const auto lost = network->see(input, everything(input));
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::kDeviceLost);
  EXPECT_FALSE(network->on_spare());
}

/// Within a region of several runs too: what the device has seen and what the spare sees are one.
TEST(Network, ASpareTakesThePlaceOfADeviceThatIsLost) {
  const Planes small = random_input(96, 64);
  const Planes large = random_input(20 * kBlock_px, 20 * kBlock_px);  // 400 blocks
  auto whole = network_of(noise({16, 16, 16}));
  for (const int good_runs : {0, 1, 2}) {
    auto network = Network::create(noise({16, 16, 16}), lost_after(good_runs));
    ASSERT_TRUE(network);
    network->fall_back_on([] { return reference::create_program(1); });
    for (const Planes& input : {small, large, small}) {
      const auto got = network->see(input, everything(input));
      const auto wanted = whole.see(input, everything(input));
      ASSERT_TRUE(got && wanted) << good_runs;
      EXPECT_EQ(apart(*got, *wanted), 0) << good_runs;
    }
    EXPECT_TRUE(network->on_spare());
  }
}

}  // namespace
}  // namespace flowdlo::field
