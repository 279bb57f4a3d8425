#include "synth/stereo_pair.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "synth/look.hpp"
#include "synth/pixel_noise.hpp"

#ifdef FLOWDLO_WITH_MATCHER
#include <opencv2/calib3d.hpp>
#endif

namespace flowdlo::synth {
namespace {

using Eigen::Vector3f;

constexpr int kFine = 2;               // rays a pixel of an eye, each way
constexpr float kDotPitch = 0.0155F;   // radians between the projector's dots,
constexpr float kDotShare = 0.7F;      // of which so many are there,
constexpr float kDotSpread = 0.0025F;  // each a bell of this deviation
constexpr float kLit_m = 0.6F;         // where dots are as bright as the surface's own light
constexpr int kWindow_px = 5;          // of the matcher
constexpr int kSubpixels = 16;         // of its disparities
constexpr int kSpeckle_px = 60;        // smaller patches are thrown away

/// A surface as infrared light shows it: how much it returns, and how that varies over it.
struct Coat {
  float albedo = 0.5F;
  float grain = 0.1F;
  float cell_m = 0.004F;
};

Coat draw_coat(Dice& dice) {
  return {static_cast<float>(dice.uniform(0.2, 0.9)), static_cast<float>(dice.uniform(0.02, 0.35)),
          static_cast<float>(dice.log_uniform(0.001, 0.02))};
}

struct Scene {
  std::vector<Coat> ropes;
  std::vector<Coat> things;
  Coat ground;
  float ambient = 0.5F;
  float dots = 1;  // how bright
  float noise = 1.5F;
  PixelNoise texture{0};
  PixelNoise pattern{0};
  Vector3f along;
  Vector3f across;
};

Scene draw_scene(const View& view, const StereoRig& rig, std::size_t ropes, std::size_t things,
                 Dice& dice) {
  Scene scene;
  const Coat rope = draw_coat(dice);
  for (std::size_t k = 0; k < ropes; ++k) scene.ropes.push_back(k == 0 ? rope : draw_coat(dice));
  for (std::size_t k = 0; k < things; ++k) scene.things.push_back(draw_coat(dice));
  scene.ground = draw_coat(dice);
  scene.ambient = static_cast<float>(dice.uniform(0.15, 0.7));
  scene.dots = rig.has_dots ? static_cast<float>(dice.uniform(0.5, 1.5)) : 0.0F;
  scene.noise = static_cast<float>(dice.uniform(0.8, 2.5));
  scene.texture = PixelNoise(dice.word());
  scene.pattern = PixelNoise(dice.word());
  const Vector3d normal = view.ground.normal;
  const Vector3d along = normal.cross(Vector3d(0.3, 1, 0.2)).normalized();
  scene.along = along.cast<float>();
  scene.across = normal.cross(along).cast<float>();
  return scene;
}

/// [0, 1] what the projector sends along the direction (x, y, 1): a jittered grid of dots.
float dots_at(const PixelNoise& pattern, float x, float y) {
  const float i = std::floor(x / kDotPitch);
  const float j = std::floor(y / kDotPitch);
  float sum = 0;
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const float ci = i + static_cast<float>(di);
      const float cj = j + static_cast<float>(dj);
      const auto a = static_cast<std::uint32_t>(static_cast<int>(ci) + 4096);
      const auto b = static_cast<std::uint32_t>(static_cast<int>(cj) + 4096);
      if (pattern.uniform(a, b) > kDotShare) continue;
      const float u = (ci + pattern.uniform(a, b + 8192)) * kDotPitch - x;
      const float v = (cj + pattern.uniform(a + 8192, b)) * kDotPitch - y;
      sum += std::exp(-(u * u + v * v) / (2 * kDotSpread * kDotSpread));
    }
  }
  return std::min(1.0F, sum);
}

/// The scene as one eye has it before itself.
struct Eye {
  Sensor sensor;
  View view;
  std::vector<Thing> things;
};

Eye eye_at(const View& view, const StereoRig& rig, std::span<const Thing> things, double along_m) {
  Eye eye;
  eye.sensor = *view.sensor;
  eye.sensor.width = rig.width * kFine;
  eye.sensor.height = rig.height * kFine;
  eye.view = view;
  const auto focal = static_cast<float>(rig.focal_px * kFine);
  eye.view.camera = {focal, focal, 0.5F * static_cast<float>(eye.sensor.width - 1),
                     0.5F * static_cast<float>(eye.sensor.height - 1)};
  const Vector3d from(along_m, 0, 0);
  eye.view.shift -= from;
  eye.view.ground.offset_m -= view.ground.normal.dot(from);
  for (Curve& curve : eye.view.curves) {
    for (Vector3d& point : curve.points) point -= from;
  }
  eye.things.assign(things.begin(), things.end());
  for (Thing& thing : eye.things) {
    for (Capsule& capsule : thing.capsules) {
      capsule.from -= from;
      capsule.to -= from;
    }
    for (Box& box : thing.boxes) box.middle -= from;
  }
  return eye;
}

/// Light of one eye's pixels, kFine x kFine of them to a pixel of the rig.
class Exposure {
 public:
  Exposure(const Scene& scene, const Eye& eye, const Tracer& tracer, std::span<const Rope> ropes,
           double eye_m, double projector_m)
      : scene_(scene),
        eye_(eye),
        tracer_(tracer),
        ropes_(ropes),
        eye_m_(static_cast<float>(eye_m)),
        projector_(static_cast<float>(projector_m - eye_m), 0, 0) {}

  [[nodiscard]] std::vector<float> light(const Picture& picture) const {
    const auto width = static_cast<std::size_t>(eye_.sensor.width);
    std::vector<float> image(picture.depth_m.size(), 0.02F);
    std::vector<bool> done(image.size(), false);
    const auto point_of = [&](std::size_t pixel, float z_m) {
      const Intrinsics& camera = eye_.view.camera;
      return Vector3f(z_m * (static_cast<float>(pixel % width) - camera.cx) / camera.fx,
                      z_m * (static_cast<float>(pixel / width) - camera.cy) / camera.fy, z_m);
    };
    for (const Surface& seen : picture.surfaces) {
      if (done[seen.pixel]) continue;
      done[seen.pixel] = true;
      const Vector3f point = point_of(seen.pixel, seen.z_m);
      image[seen.pixel] = shade(albedo(seen, point), point, seen.normal);
    }
    const Vector3f normal = eye_.view.ground.normal.cast<float>();
    for (std::size_t i = 0; i < image.size(); ++i) {
      if (done[i] || picture.depth_m[i] <= 0) continue;
      const Vector3f point = point_of(i, picture.depth_m[i]);
      image[i] = shade(ground_albedo(point), point, normal);
    }
    return image;
  }

 private:
  [[nodiscard]] float varied(const Coat& coat, float x, float y) const {
    const float fine = scene_.texture.smooth(x, y, coat.cell_m) - 0.5F;
    const float coarse = scene_.texture.smooth(x, y, 6 * coat.cell_m) - 0.5F;
    return coat.albedo * std::max(0.1F, 1 + coat.grain * (1.4F * fine + coarse));
  }

  /// Textures belong to the surfaces: both eyes see the same.
  [[nodiscard]] float ground_albedo(const Vector3f& point) const {
    const Vector3f p = point + Vector3f(eye_m_, 0, 0);
    return varied(scene_.ground, scene_.along.dot(p), scene_.across.dot(p));
  }

  [[nodiscard]] float albedo(const Surface& seen, const Vector3f& point) const {
    if (seen.thing != kRopeThing) {
      const Vector3f p = point + Vector3f(eye_m_, 0, 0);
      return varied(scene_.things[seen.thing], p.x() + p.z(), p.y() - p.z());
    }
    const Curve& curve = eye_.view.curves[seen.rope];
    const Coat& coat = scene_.ropes[seen.rope];
    return coat.albedo *
           (1 + 4 * coat.grain * (braid(curve, seen, point, ropes_[seen.rope].radius_m) - 1));
  }

  [[nodiscard]] float shade(float albedo, const Vector3f& point, const Vector3f& normal) const {
    const Vector3f seen_along = point.normalized();
    float light = scene_.ambient * (0.6F + 0.4F * std::max(0.0F, -normal.dot(seen_along)));
    if (scene_.dots > 0) {
      const Vector3f way = point - projector_;
      const float facing = std::max(0.0F, -normal.dot(way.normalized()));
      const float dot = facing > 0 && way.z() > 0
                            ? dots_at(scene_.pattern, way.x() / way.z(), way.y() / way.z())
                            : 0.0F;
      if (dot > 0.02F && !tracer_.shadowed(point + 0.0004F * normal, projector_)) {
        light += scene_.dots * dot * facing * kLit_m * kLit_m / way.squaredNorm();
      }
    }
    return albedo * light;
  }

  const Scene& scene_;
  const Eye& eye_;
  const Tracer& tracer_;
  std::span<const Rope> ropes_;
  float eye_m_;
  Vector3f projector_;  // before the eye
};

/// Means of kFine x kFine, exposed so that little is beyond white.
std::vector<std::uint8_t> developed(const std::vector<float>& light, const StereoRig& rig,
                                    float exposure, const PixelNoise& noise, float deviation) {
  std::vector<std::uint8_t> image;
  image.reserve(static_cast<std::size_t>(rig.width) * static_cast<std::size_t>(rig.height));
  for (int v = 0; v < rig.height; ++v) {
    for (int u = 0; u < rig.width; ++u) {
      float sum = 0;
      for (int y = 0; y < kFine; ++y) {
        for (int x = 0; x < kFine; ++x) {
          sum +=
              light[static_cast<std::size_t>((v * kFine + y) * rig.width * kFine + u * kFine + x)];
        }
      }
      const float level =
          255 * exposure * sum / (kFine * kFine) +
          deviation * noise.bell(static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
      image.push_back(static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F)));
    }
  }
  return image;
}

/// What makes nineteen of twenty pixels less than nine tenths of white.
float exposure_of(std::vector<float> light) {
  const auto at = light.begin() + static_cast<std::ptrdiff_t>(light.size() * 19 / 20);
  std::nth_element(light.begin(), at, light.end());
  return 0.9F / std::max(0.05F, *at);
}

/// [rig.height, rig.width] pixels; 0 and below: none.
Result<std::vector<float>> disparities(const StereoRig& rig, const EyePicture& eyes,
                                       double nearest_m) {
#ifdef FLOWDLO_WITH_MATCHER
  const double most = rig.focal_px * rig.baseline_m / nearest_m;
  // OpenCV throws where it is to look farther than the picture is wide.
  const int steps =
      16 * std::min(static_cast<int>(std::ceil((most + 1) / 16)), (rig.width - kWindow_px) / 16);
  const auto image = [&](const std::vector<std::uint8_t>& of) {  // OpenCV has no view of constants
    return cv::Mat(rig.height, rig.width, CV_8UC1, const_cast<std::uint8_t*>(of.data()));
  };
  constexpr int kArea = kWindow_px * kWindow_px;
  const auto matcher = cv::StereoSGBM::create(0, steps, kWindow_px, 8 * kArea, 32 * kArea, 1, 31,
                                              10, kSpeckle_px, 1, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat fixed;
  matcher->compute(image(eyes.left), image(eyes.right), fixed);
  std::vector<float> disparity;
  disparity.reserve(eyes.left.size());
  for (int v = 0; v < rig.height; ++v) {
    const auto* const row = fixed.ptr<std::int16_t>(v);
    for (int u = 0; u < rig.width; ++u) {
      disparity.push_back(static_cast<float>(row[u]) / static_cast<float>(kSubpixels));
    }
  }
  return disparity;
#else
  (void)rig;
  (void)eyes;
  (void)nearest_m;
  return Error{ErrorCode::kBadInput,
               "synth: matched depth: expected a build with OpenCV's calib3d, got one without; "
               "install libopencv-calib3d-dev and build again"};
#endif
}

}  // namespace

std::optional<StereoRig> rig_of(const Sensor& sensor) {
  // Places and fields of view are those of public data sheets, roughly.
  if (sensor.principle != DepthPrinciple::kStereo) return std::nullopt;
  if (sensor.name.starts_with("realsense_d435")) {
    return StereoRig{848, 480, 425, 0.015, sensor.baseline_m, 0.029, true};
  }
  if (sensor.name.starts_with("realsense_d415")) {
    return StereoRig{848, 480, 617, 0.015, sensor.baseline_m, 0.028, true};
  }
  const double share = sensor.width > 1280 ? 0.5 : 1.0;  // matched in the colour camera's own view
  return StereoRig{static_cast<int>(share * sensor.width),
                   static_cast<int>(share * sensor.height),
                   share * sensor.focal_px,
                   0,
                   sensor.baseline_m,
                   0,
                   false};
}

Result<EyePicture> infrared(const View& view, const StereoRig& rig, std::span<const Rope> ropes,
                            std::span<const Thing> things, Dice& dice) {
  const Scene scene = draw_scene(view, rig, ropes.size(), things.size(), dice);
  const double projector_m = rig.left_m + rig.dots_m;
  float exposure = 0;  // of the left eye, for both
  const auto expose = [&](double eye_m) -> Result<std::vector<std::uint8_t>> {
    Eye eye = eye_at(view, rig, things, eye_m);
    eye.view.sensor = &eye.sensor;
    const auto tracer = Tracer::create(eye.view, ropes, eye.things);
    if (!tracer) return tracer.error();
    const auto light =
        Exposure(scene, eye, *tracer, ropes, eye_m, projector_m).light(tracer->take_picture());
    if (exposure <= 0) exposure = exposure_of(light);
    return developed(light, rig, exposure, PixelNoise(dice.word()), scene.noise);
  };
  auto left = expose(rig.left_m);
  if (!left) return left.error();
  auto right = expose(rig.left_m + rig.baseline_m);
  if (!right) return right.error();
  return EyePicture{*std::move(left), *std::move(right)};
}

Result<std::vector<float>> matched(const View& view, const StereoRig& rig, const EyePicture& eyes,
                                   double nearest_m) {
  const auto disparity = disparities(rig, eyes, nearest_m);
  if (!disparity) return disparity.error();
  const int width = view.sensor->width;
  const int height = view.sensor->height;
  std::vector<float> depth_m(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto scale = static_cast<float>(rig.focal_px * rig.baseline_m);
  const auto focal = static_cast<float>(rig.focal_px);
  const auto left_m = static_cast<float>(rig.left_m);
  const float cx = 0.5F * static_cast<float>(rig.width - 1);
  const float cy = 0.5F * static_cast<float>(rig.height - 1);
  const Intrinsics& camera = view.camera;
  // Each pixel of the eye is a patch of the colour image, and the nearest patch shows.
  for (int v = 0; v < rig.height; ++v) {
    for (int u = 0; u < rig.width; ++u) {
      const float d = (*disparity)[static_cast<std::size_t>(v * rig.width + u)];
      if (!(d > 0)) continue;
      const float z = scale / d;
      if (z > static_cast<float>(view.sensor->farthest_m)) continue;
      const auto column = [&](float at) {
        return camera.fx * ((at - cx) / focal + left_m / z) + camera.cx;
      };
      const auto row = [&](float at) { return camera.fy * (at - cy) / focal + camera.cy; };
      const auto pixel = [](float at, int end) {
        return static_cast<int>(std::lround(std::clamp(at, -1.0F, static_cast<float>(end))));
      };
      const auto at_u = static_cast<float>(u);
      const auto at_v = static_cast<float>(v);
      const int bottom = std::min(pixel(row(at_v + 0.5F), height), height - 1);
      const int right = std::min(pixel(column(at_u + 0.5F), width), width - 1);
      for (int y = std::max(0, pixel(row(at_v - 0.5F), height)); y <= bottom; ++y) {
        for (int x = std::max(0, pixel(column(at_u - 0.5F), width)); x <= right; ++x) {
          float& to = depth_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
          if (to <= 0 || z < to) to = z;
        }
      }
    }
  }
  return depth_m;
}

}  // namespace flowdlo::synth
