#include "synth/depth_sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "synth/pixel_noise.hpp"

namespace flowdlo::synth {
namespace {

constexpr float kJump_m = 0.005F;       // between neighbours: an edge
constexpr float kShadowJump_m = 0.02F;  // that hides something from one eye of a stereo camera
constexpr float kSubpixels = 32;        // steps a pixel of disparity
constexpr int kMostUnits = 65535;       // of a 16-bit depth image

// An edge's pixel and its neighbour in the ideal picture.
template <class Visit>
void for_each_edge(const View& view, const Picture& ideal, Visit visit) {
  const int width = view.sensor->width;
  const int height = view.sensor->height;
  constexpr std::array<std::array<int, 2>, 4> kSides = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (const Surface& seen : ideal.surfaces) {
    const int u = static_cast<int>(seen.pixel) % width;
    const int v = static_cast<int>(seen.pixel) / width;
    for (const auto& side : kSides) {
      const int x = u + side[0];
      const int y = v + side[1];
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const auto other = static_cast<std::uint32_t>(y * width + x);
      const float jump = ideal.depth_m[other] - seen.z_m;
      if (std::abs(jump) > kJump_m || ideal.depth_m[other] <= 0) visit(seen, other, jump, side[0]);
    }
  }
}

// What only one of the two eyes sees, left of something near, has no depth.
void cast_stereo_shadow(const View& view, const Picture& ideal, const Surface& seen,
                        std::uint32_t other, std::vector<float>& depth_m) {
  const float behind = ideal.depth_m[other];
  const double shift = view.camera.fx * view.sensor->baseline_m * (1 / seen.z_m - 1 / behind);
  const int column = static_cast<int>(other) % view.sensor->width;
  const int reach = std::min(static_cast<int>(shift), column);
  for (int k = 0; k <= reach; ++k) {
    const std::size_t pixel = other - static_cast<std::uint32_t>(k);
    if (ideal.depth_m[pixel] > seen.z_m + kShadowJump_m) depth_m[pixel] = 0;
  }
}

void spoil_edges(const View& view, const Picture& ideal, const DepthFaults& faults,
                 const PixelNoise& noise, std::vector<float>& depth_m) {
  const bool stereo = faults.noise && view.sensor->principle == DepthPrinciple::kStereo;
  for_each_edge(view, ideal, [&](const Surface& seen, std::uint32_t other, float jump, int side) {
    const float behind = ideal.depth_m[other];
    if (noise.uniform(seen.pixel, 1) < faults.flying && behind > 0) {
      const float share = noise.uniform(seen.pixel, 2);
      const bool inwards = noise.uniform(seen.pixel, 3) < 0.5F;
      depth_m[inwards ? seen.pixel : other] = (1 - share) * seen.z_m + share * behind;
    }
    if (noise.uniform(seen.pixel, 4) < faults.dropout) depth_m[seen.pixel] = 0;
    if (noise.uniform(other, 5) < faults.dropout) depth_m[other] = 0;
    if (stereo && side < 0 && jump > kShadowJump_m) {
      cast_stereo_shadow(view, ideal, seen, other, depth_m);
    }
  });
}

bool any_holds(const std::vector<Stretch>& stretches, const Surface& seen) {
  return std::any_of(stretches.begin(), stretches.end(),
                     [&](const Stretch& s) { return s.holds(seen.rope, seen.along); });
}

void spoil_rope(const View& view, const Picture& ideal, const DepthFaults& faults,
                const PixelNoise& noise, std::vector<float>& depth_m) {
  const auto width = static_cast<std::uint32_t>(view.sensor->width);
  const float grain = 4.0F * static_cast<float>(width) / 640.0F;
  for (const Surface& seen : ideal.surfaces) {
    if (seen.thing != kRopeThing) continue;
    const auto u = static_cast<float>(seen.pixel % width);
    const auto v = static_cast<float>(seen.pixel / width);
    const Eigen::Vector3f ray((u - view.camera.cx) / view.camera.fx,
                              (v - view.camera.cy) / view.camera.fy, 1);
    float& z = depth_m[seen.pixel];
    if (any_holds(faults.sunk, seen) && view.has_ground) {
      const double behind = view.ground.offset_m / view.ground.normal.dot(ray.cast<double>());
      if (behind > 0) z += 0.9F * (static_cast<float>(behind) - z);
    }
    if (any_holds(faults.lost, seen)) z = 0;
    if (any_holds(faults.black, seen) && noise.smooth(u, v, grain) < 0.62F) z = 0;
    const float facing = -seen.normal.dot(ray.normalized());
    if (any_holds(faults.shiny, seen) && facing > 0.75F) z = 0;
  }
}

void punch_holes(const View& view, std::span<const Rope> ropes, int count, const PixelNoise& noise,
                 std::vector<float>& depth_m) {
  for (int k = 0; k < count; ++k) {
    const auto salt = static_cast<std::uint32_t>(k);
    const std::size_t rope = salt % ropes.size();
    const double radius_m = ropes[rope].radius_m;
    const auto& points = view.curves[rope].points;
    const auto at =
        static_cast<std::size_t>(noise.uniform(salt, 11) * static_cast<float>(points.size() - 1));
    const Vector2d middle = view.project(points[at]);
    const double radii = 2.0 + 6.0 * noise.uniform(salt, 12);
    const double reach = std::clamp(radii * radius_m * view.camera.fx / points[at].z(), 3.0,
                                    0.06 * view.sensor->width);
    const int top = std::max(0, static_cast<int>(middle.y() - reach));
    const int bottom = std::min(view.sensor->height - 1, static_cast<int>(middle.y() + reach));
    const int left = std::max(0, static_cast<int>(middle.x() - reach));
    const int right = std::min(view.sensor->width - 1, static_cast<int>(middle.x() + reach));
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u) {
        if ((Vector2d(u, v) - middle).norm() > reach) continue;
        depth_m[static_cast<std::size_t>(v * view.sensor->width + u)] = 0;
      }
    }
  }
}

// Half of the noise is shared by the pixels of one matching block.
void add_stereo_noise(const View& view, const PixelNoise& noise, std::vector<float>& depth_m) {
  const Sensor& sensor = *view.sensor;
  const auto scale = static_cast<float>(view.camera.fx * sensor.baseline_m);
  const auto deviation = static_cast<float>(0.7071 * sensor.disparity_px);
  for (int v = 0; v < sensor.height; ++v) {
    float* row = depth_m.data() + static_cast<std::size_t>(v) * sensor.width;
    const auto line = static_cast<std::uint32_t>(v);
    for (int u = 0; u < sensor.width; ++u) {
      const auto column = static_cast<std::uint32_t>(u);
      const float error =
          deviation * (noise.bell(column, line) + noise.bell(column / 4 + 8192, line / 3));
      const float disparity = scale / std::max(row[u], 0.01F) + error;
      const float steps = static_cast<float>(static_cast<int>(disparity * kSubpixels + 0.5F));
      row[u] = row[u] > 0 ? scale * kSubpixels / std::max(1.0F, steps) : 0.0F;
    }
  }
}

// Deviation grows with the square of the distance, from a floor.
void add_flight_noise(const View& view, const PixelNoise& noise, std::vector<float>& depth_m) {
  const Sensor& sensor = *view.sensor;
  const auto deviation = static_cast<float>(sensor.noise_m);
  for (int v = 0; v < sensor.height; ++v) {
    float* row = depth_m.data() + static_cast<std::size_t>(v) * sensor.width;
    for (int u = 0; u < sensor.width; ++u) {
      const float z = row[u];
      const float error = deviation * (0.5F + 0.5F * z * z) *
                          noise.bell(static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
      row[u] = z > 0 ? std::max(z + error, 0.001F) : 0.0F;
    }
  }
}

void round_to_units(bool whole_mm, std::vector<float>& depth_m) {
  const int each = whole_mm ? 10 : 1;
  const auto per_step = static_cast<float>(1 / (kDepthScale_m * each));
  for (float& z : depth_m) {
    const int units = each * static_cast<int>(z * per_step + 0.5F);
    z = units <= kMostUnits ? static_cast<float>(units * kDepthScale_m) : 0.0F;
  }
}

}  // namespace

std::vector<float> measured_depth(const View& view, const Picture& ideal,
                                  std::span<const Rope> ropes, const DepthFaults& faults,
                                  std::uint32_t seed) {
  std::vector<float> depth_m = ideal.depth_m;
  const PixelNoise noise(seed);
  spoil_rope(view, ideal, faults, noise, depth_m);
  if (faults.noise || faults.flying > 0 || faults.dropout > 0) {
    spoil_edges(view, ideal, faults, noise, depth_m);
  }
  punch_holes(view, ropes, faults.holes, noise, depth_m);
  if (faults.noise && view.sensor->principle == DepthPrinciple::kStereo) {
    add_stereo_noise(view, noise, depth_m);
  } else if (faults.noise) {
    add_flight_noise(view, noise, depth_m);
  }
  round_to_units(faults.whole_mm, depth_m);
  return depth_m;
}

std::vector<float> spoiled_depth(const View& view, const Picture& ideal,
                                 std::span<const Rope> ropes, const DepthFaults& faults,
                                 std::vector<float> depth_m, std::uint32_t seed) {
  const PixelNoise noise(seed);
  DepthFaults left = faults;
  left.sunk.clear();  // matching has done that
  spoil_rope(view, ideal, left, noise, depth_m);
  punch_holes(view, ropes, faults.holes, noise, depth_m);
  round_to_units(faults.whole_mm, depth_m);
  return depth_m;
}

}  // namespace flowdlo::synth
