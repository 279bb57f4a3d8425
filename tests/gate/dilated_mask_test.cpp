// S_M of Eq. (3.32). The camera has f = 1 and its centre at pixel (0, 0): a node (u, v, 1) projects
// to pixel (u, v).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gate/gate.hpp"
#include "random/philox.hpp"

namespace flowdlo::gate {
namespace {

constexpr Intrinsics kCamera{1, 1, 0, 0};

struct Picture {
  int width;
  int height;
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);

  void set(int u, int v, std::uint8_t value = 255) {
    mask[static_cast<std::size_t>(v * width + u)] = value;
  }
  [[nodiscard]] bool is_set(int u, int v) const {
    return u >= 0 && v >= 0 && u < width && v < height &&
           mask[static_cast<std::size_t>(v * width + u)] > 127;
  }
  [[nodiscard]] Frame frame() const { return {width, height, kCamera, {}, mask, {}}; }
};

Centerline line(Point3 from, Point3 to) {
  const auto between = [](float a, float b, double t) {
    return static_cast<float>((1 - t) * static_cast<double>(a) + t * static_cast<double>(b));
  };
  Centerline nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double t = static_cast<double>(i) / (kNodes - 1);
    nodes[i] = {between(from.x, to.x, t), between(from.y, to.y, t), between(from.z, to.z, t)};
  }
  return nodes;
}

/// Whether the mask covers pixel (u, v): a curve that stays there has agreement 1 or 0.
bool covers(const DilatedMask& mask, float u, float v) {
  return mask.agreement(line({u, v, 1}, {u, v, 1}), kCamera) > 0.5F;
}

TEST(DilatedMask, GrowsAPixelToADiscOfFourPixels) {  // Sec. 3.6
  Picture picture{640, 40};
  picture.set(20, 20);
  const DilatedMask mask(picture.frame());
  int covered = 0;
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < 40; ++u) {
      const int squared = (u - 20) * (u - 20) + (v - 20) * (v - 20);
      EXPECT_EQ(covers(mask, static_cast<float>(u), static_cast<float>(v)), squared <= 16);
      covered += squared <= 16 ? 1 : 0;
    }
  }
  EXPECT_EQ(covered, 49);  // lattice points of a disc of radius 4
}

TEST(DilatedMask, ScalesItsRadiusWithTheWidth) {  // spec section 5
  Picture picture{1280, 3};
  picture.set(100, 1);
  const DilatedMask mask(picture.frame());
  EXPECT_TRUE(covers(mask, 108, 1));
  EXPECT_FALSE(covers(mask, 109, 1));
}

TEST(DilatedMask, EqualsASearchOverTheDiscOnRandomMasks) {
  for (const double share : {0.002, 0.05, 0.5}) {
    Picture picture{60, 45};
    for (int i = 0; i < 60 * 45; ++i) {
      const auto words = random::philox(11, static_cast<std::uint64_t>(i));
      if (random::uniform(words[0]) < share) picture.set(i % 60, i / 60);
    }
    const DilatedMask mask(picture.frame(), {.mask_dilation_px = 53.4F});  // 5.006 px
    for (int v = 0; v < 45; ++v) {
      for (int u = 0; u < 60; ++u) {
        bool expected = false;
        for (int dv = -5; dv <= 5; ++dv) {
          for (int du = -5; du <= 5; ++du) {
            expected |= du * du + dv * dv <= 25 && picture.is_set(u + du, v + dv);
          }
        }
        ASSERT_EQ(covers(mask, static_cast<float>(u), static_cast<float>(v)), expected)
            << u << ", " << v;
      }
    }
  }
}

TEST(DilatedMask, TakesMaskValuesAboveOneHalfOnly) {
  Picture picture{2, 1};
  picture.set(0, 0, 127);
  picture.set(1, 0, 128);
  const DilatedMask mask(picture.frame());  // radius 4 * 2 / 640: none
  EXPECT_FALSE(covers(mask, 0, 0));
  EXPECT_TRUE(covers(mask, 1, 0));
}

TEST(DilatedMask, OfOnePixelCoversThatPixelOnly) {
  Picture picture{1, 1};
  EXPECT_FALSE(covers(DilatedMask(picture.frame()), 0, 0));
  picture.set(0, 0);
  const DilatedMask mask(picture.frame());
  EXPECT_TRUE(covers(mask, 0, 0));
  EXPECT_FALSE(covers(mask, 1, 0));
  EXPECT_FALSE(covers(mask, 0, -1));
}

TEST(Agreement, LooksUpTheNearestPixel) {  // Eq. (3.32)
  Picture picture{40, 10};
  picture.set(20, 5);
  const DilatedMask mask(picture.frame(), {.mask_dilation_px = 0});
  EXPECT_TRUE(covers(mask, 19.6F, 5.4F));
  EXPECT_TRUE(covers(mask, 20.4F, 4.6F));
  EXPECT_FALSE(covers(mask, 19.4F, 5));
  EXPECT_FALSE(covers(mask, 20, 5.6F));
}

// 63 segments of 2 px: samples at u = 0, 1, ..., 126, 127 of them. The mask's columns 0..59 grow
// by one pixel (4 * 160 / 640): 61 samples hit.
TEST(Agreement, IsTheShareOfOnePixelSamplesWorkedByHand) {  // Eq. (3.32)
  Picture picture{160, 20};
  for (int v = 0; v < 20; ++v) {
    for (int u = 0; u < 60; ++u) picture.set(u, v);
  }
  const DilatedMask mask(picture.frame());
  EXPECT_FLOAT_EQ(mask.agreement(line({0, 10, 1}, {126, 10, 1}), kCamera), 61.0F / 127);
}

// Segments of 0.5 px give one sample each, so that all 64 nodes count; 0..31.5 px, of which
// u = 0, ..., 9.5 - without 9.5, which is nearest to 10 - lie on columns 0..9: 19 samples.
TEST(Agreement, CountsEachNodeWhereNodesAreLessThanAPixelApart) {  // Eq. (3.32)
  Picture picture{64, 3};
  for (int u = 0; u < 10; ++u) picture.set(u, 1);
  const DilatedMask mask(picture.frame(), {.mask_dilation_px = 0});
  EXPECT_FLOAT_EQ(mask.agreement(line({0, 1, 1}, {31.5F, 1, 1}), kCamera), 19.0F / 64);
}

// Samples at u = -32, -31, ..., 31: 32 of 64 lie in the image.
TEST(Agreement, CountsSamplesOutsideTheImageAsMisses) {  // Eq. (3.32)
  Picture picture{64, 3};
  for (int u = 0; u < 64; ++u) picture.set(u, 1);
  const DilatedMask mask(picture.frame());
  EXPECT_FLOAT_EQ(mask.agreement(line({-32, 1, 1}, {31, 1, 1}), kCamera), 32.0F / 64);
  EXPECT_EQ(mask.agreement(line({-99, 1, 1}, {-36, 1, 1}), kCamera), 0);
  EXPECT_EQ(mask.agreement(line({0, 9, 1}, {63, 9, 1}), kCamera), 0);
}

// Image 30 x 40, diagonal 50. 62 segments of 0 px on the mask give 62 hits; the last one goes
// behind the camera: 50 misses, and one more for the node itself.
TEST(Agreement, CountsASegmentToBehindTheCameraAsADiagonalOfMisses) {  // Eq. (3.32)
  Picture picture{30, 40};
  picture.set(3, 4);
  const DilatedMask mask(picture.frame());
  Centerline nodes = line({3, 4, 1}, {3, 4, 1});
  nodes.back() = {3, 4, -1};
  EXPECT_FLOAT_EQ(mask.agreement(nodes, kCamera), 62.0F / 113);
  EXPECT_EQ(mask.agreement(line({-3, -4, -1}, {-3, -4, -1}), kCamera), 0);
  EXPECT_EQ(mask.agreement(line({0, 0, 0}, {0, 0, 0}), kCamera), 0);
}

// One node 2^20 px to the right: there and back 2 * (2^20 - 8) samples besides 61 + 1 that stay;
// of the way out u = 8..15 hit, of the way back u = 15..9.
TEST(Agreement, FollowsALongSegmentThroughTheImage) {  // Eq. (3.32)
  Picture picture{16, 3};
  for (int u = 0; u < 16; ++u) picture.set(u, 1);
  const DilatedMask mask(picture.frame());
  Centerline nodes = line({8, 1, 1}, {8, 1, 1});
  nodes[30].x = 1048576;
  const double samples = 2.0 * (1048576 - 8) + 62;
  EXPECT_FLOAT_EQ(mask.agreement(nodes, kCamera), static_cast<float>((62 + 8 + 7) / samples));
}

TEST(Agreement, EndsInTimeAndIsFiniteForAbsurdProjections) {
  Picture picture{16, 16};
  for (int i = 0; i < 16; ++i) picture.set(i, i);
  const DilatedMask mask(picture.frame());
  constexpr float kHuge = std::numeric_limits<float>::max();
  for (const float size : {1e9F, 1e12F, 1e30F, kHuge}) {
    const float agreement = mask.agreement(line({-size, -size, 1e-5F}, {size, size, 1}), kCamera);
    EXPECT_GE(agreement, 0) << size;
    EXPECT_LE(agreement, 1) << size;
  }
}

TEST(Agreement, OfANonFiniteCenterlineIsZero) {
  Picture picture{16, 16};
  picture.set(3, 3);
  const DilatedMask mask(picture.frame());
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Centerline nodes = line({3, 3, 1}, {3, 3, 1});
    nodes[17].y = bad;
    EXPECT_EQ(mask.agreement(nodes, kCamera), 0);
  }
}

/// The definition without any shortcut.
float count_every_sample(const Picture& picture, const Centerline& nodes) {
  double hits = 0;
  double samples = 0;
  const auto sample = [&](double u, double v) {
    const bool hit = picture.is_set(static_cast<int>(std::floor(u + 0.5)),
                                    static_cast<int>(std::floor(v + 0.5)));
    hits += hit ? 1 : 0;
    samples += 1;
  };
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double u = static_cast<double>(nodes[i].x);
    const double v = static_cast<double>(nodes[i].y);
    const double du = static_cast<double>(nodes[i + 1].x) - u;
    const double dv = static_cast<double>(nodes[i + 1].y) - v;
    const double length = std::hypot(du, dv);
    for (int k = 0; k == 0 || k < length - 1e-3; ++k)
      sample(u + k * du / length, v + k * dv / length);
  }
  sample(static_cast<double>(nodes.back().x), static_cast<double>(nodes.back().y));
  return static_cast<float>(hits / samples);
}

TEST(Agreement, EqualsACountOfEverySampleOnCurvesInAndOutOfTheImage) {  // Eq. (3.32)
  Picture picture{80, 60};
  for (int i = 0; i < 80 * 60; ++i) {
    if (random::philox(3, static_cast<std::uint64_t>(i))[0] % 3 == 0) picture.set(i % 80, i / 80);
  }
  const DilatedMask mask(picture.frame(), {.mask_dilation_px = 0});
  for (std::uint64_t curve = 0; curve < 50; ++curve) {
    Centerline nodes{};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto g = random::gaussian(curve, i);
      nodes[i] = {40 + 60 * g[0], 30 + 60 * g[1], 1};
    }
    EXPECT_NEAR(mask.agreement(nodes, kCamera), count_every_sample(picture, nodes), 2e-4) << curve;
  }
}

}  // namespace
}  // namespace flowdlo::gate
