#include "synth/tracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "synth/blocks.hpp"
#include "synth/embree.hpp"

namespace flowdlo::synth {
namespace {

using Eigen::Vector3f;
constexpr float kNearest_m = 0.02F;
constexpr std::size_t kStride = 2;  // samples of the curve between the rope's cones: one radius

Error failed(RTCDevice device, const char* what) {
  const auto code = static_cast<int>(rtcGetDeviceError(device));
  return {ErrorCode::kInternal, std::string("synth: Embree failed to make ") + what + " (error " +
                                    std::to_string(code) + "); is there enough memory?"};
}

void put(float* to, const Vector3d& p, double radius_m) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(p[k]);
  to[3] = static_cast<float>(radius_m);
}

bool attach(RTCScene scene, const embree::Geometry& geometry) {
  rtcCommitGeometry(geometry.get());
  return rtcAttachGeometry(scene, geometry.get()) != RTC_INVALID_GEOMETRY_ID;
}

float* vertices(RTCGeometry geometry, RTCFormat format, std::size_t floats, std::size_t count) {
  return static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, format,
                                                     floats * sizeof(float), count));
}

unsigned* indices(RTCGeometry geometry, RTCFormat format, std::size_t each, std::size_t count) {
  return static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, format,
                                                        each * sizeof(unsigned), count));
}

// Cones between every second sample: the chord of a bend of four radii is off by 0.03 radii, and a
// ray meets a cone in a third of the time that a cubic takes.
// A cone ends in a ball, except towards a neighbour: beyond a square end stands one without a cone.
bool add_strand(RTCDevice device, RTCScene scene, const std::vector<Vector3d>& points,
                std::size_t stride, double radius_m, bool square_ends) {
  const std::size_t spans = (points.size() - 1) / stride;
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE));
  float* vertex = vertices(geometry.get(), RTC_FORMAT_FLOAT4, 4, spans + 3);
  unsigned* index = indices(geometry.get(), RTC_FORMAT_UINT, 1, spans);
  auto* flags = static_cast<std::uint8_t*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR, sizeof(std::uint8_t), spans));
  if (vertex == nullptr || index == nullptr || flags == nullptr) return false;
  put(vertex, 2 * points.front() - points[stride], radius_m);
  for (std::size_t i = 0; i <= spans; ++i) {
    put(vertex + 4 * (i + 1), points[i * stride], radius_m);
  }
  put(vertex + 4 * (spans + 2), 2 * points.back() - points[points.size() - 1 - stride], radius_m);
  for (std::size_t i = 0; i < spans; ++i) {
    index[i] = static_cast<unsigned>(i + 1);
    const bool left = i > 0 || square_ends;
    const bool right = i + 1 < spans || square_ends;
    flags[i] = static_cast<std::uint8_t>((left ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0) |
                                         (right ? RTC_CURVE_FLAG_NEIGHBOR_RIGHT : 0));
  }
  return attach(scene, geometry);
}

// A disc closes each end of a tube that is cut square.
bool add_ends(RTCDevice device, RTCScene scene, const Curve& curve, double radius_m) {
  const auto& points = curve.points;
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT));
  float* vertex = vertices(geometry.get(), RTC_FORMAT_FLOAT4, 4, 2);
  auto* normal = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 2));
  if (vertex == nullptr || normal == nullptr) return false;
  put(vertex, points.front(), radius_m);
  put(vertex + 4, points.back(), radius_m);
  const Vector3d first = (points[0] - points[1]).normalized();
  const Vector3d last = (points.back() - points[points.size() - 2]).normalized();
  for (int k = 0; k < 3; ++k) {
    normal[k] = static_cast<float>(first[k]);
    normal[3 + k] = static_cast<float>(last[k]);
  }
  return attach(scene, geometry);
}

bool add_capsules(RTCDevice device, RTCScene scene, const std::vector<Capsule>& capsules) {
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE));
  float* vertex = vertices(geometry.get(), RTC_FORMAT_FLOAT4, 4, 2 * capsules.size());
  unsigned* index = indices(geometry.get(), RTC_FORMAT_UINT, 1, capsules.size());
  if (vertex == nullptr || index == nullptr) return false;
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    put(vertex + 8 * i, capsules[i].from, capsules[i].radius_m);
    put(vertex + 8 * i + 4, capsules[i].to, capsules[i].radius_m);
    index[i] = static_cast<unsigned>(2 * i);
  }
  return attach(scene, geometry);
}

bool add_boxes(RTCDevice device, RTCScene scene, const std::vector<Box>& boxes) {
  constexpr std::array<unsigned, 36> kCorners = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5,
                                                 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6,
                                                 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  float* vertex = vertices(geometry.get(), RTC_FORMAT_FLOAT3, 3, 8 * boxes.size());
  unsigned* index = indices(geometry.get(), RTC_FORMAT_UINT3, 3, 12 * boxes.size());
  if (vertex == nullptr || index == nullptr) return false;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Vector3d sign((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                          (corner & 4U) != 0 ? 1 : -1);
      const Vector3d p = boxes[i].middle + boxes[i].axes * sign.cwiseProduct(boxes[i].half_m);
      for (int k = 0; k < 3; ++k) vertex[(8 * i + corner) * 3 + k] = static_cast<float>(p[k]);
    }
    for (std::size_t k = 0; k < kCorners.size(); ++k) {
      index[36 * i + k] = static_cast<unsigned>(8 * i) + kCorners[k];
    }
  }
  return attach(scene, geometry);
}

// 1 / z is linear over the image of a plane.
void draw_ground(const View& view, std::vector<float>& depth_m) {
  const Sensor& sensor = *view.sensor;
  const Vector3d n = view.ground.normal / view.ground.offset_m;
  const auto du = static_cast<float>(n.x() / view.camera.fx);
  const auto farthest = static_cast<float>(sensor.farthest_m);
  for (int v = 0; v < sensor.height; ++v) {
    const auto start =
        static_cast<float>(n.z() - n.x() * view.camera.cx / view.camera.fx +
                           n.y() * (static_cast<float>(v) - view.camera.cy) / view.camera.fy);
    float* row = depth_m.data() + static_cast<std::size_t>(v) * sensor.width;
    for (int u = 0; u < sensor.width; ++u) {
      const float z = 1.0F / (start + du * static_cast<float>(u));
      row[u] = z > 0 && z <= farthest ? z : 0.0F;
    }
  }
}

struct Packet {
  alignas(64) std::array<int, 16> valid{};
  alignas(64) RTCRayHit16 rays{};
};

void aim(const View& view, int u0, int v0, const std::vector<float>& depth_m, Packet& packet) {
  auto& ray = packet.rays.ray;
  const auto width = static_cast<std::size_t>(view.sensor->width);
  for (int k = 0; k < 16; ++k) {
    const int u = u0 + k % kBlock_px;
    const int v = v0 + k / kBlock_px;
    const bool inside = u < view.sensor->width && v < view.sensor->height;
    packet.valid[static_cast<std::size_t>(k)] = inside ? -1 : 0;
    const float ground = inside ? depth_m[static_cast<std::size_t>(v) * width + u] : 0.0F;
    ray.org_x[k] = ray.org_y[k] = ray.org_z[k] = 0;
    ray.dir_x[k] = (static_cast<float>(u) - view.camera.cx) / view.camera.fx;
    ray.dir_y[k] = (static_cast<float>(v) - view.camera.cy) / view.camera.fy;
    ray.dir_z[k] = 1;  // so that a ray's parameter is z-depth
    ray.tnear[k] = kNearest_m;
    ray.tfar[k] = ground > 0 ? ground : static_cast<float>(view.sensor->farthest_m);
    ray.time[k] = 0;
    ray.mask[k] = 0xFFFFFFFFU;
    ray.id[k] = 0;
    ray.flags[k] = 0;
    packet.rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

// What a geometry of Embree's is.
struct Source {
  std::uint16_t thing = 0;
  std::uint16_t rope = 0;
  bool ends = false;  // of a rope: the discs that close it
  std::uint8_t strand = 0;
  std::size_t stride = kStride;  // of the curve's samples, from cone to cone
};

}  // namespace

struct Tracer::Impl {
  const View* view = nullptr;
  embree::Device device;
  embree::Scene scene;
  Blocks blocks;
  std::vector<Source> sources;
  std::vector<std::vector<std::vector<Vector3d>>> axes;  // of each strand of each rope

  // The cones' normals would show their edges; away from the axis is smooth.
  [[nodiscard]] Vector3f round_normal(const Surface& seen, const Vector3f& ray) const {
    const auto& points = axes[seen.rope][seen.strand];
    const auto i = std::min(points.size() - 2, static_cast<std::size_t>(seen.along));
    const double t = seen.along - static_cast<double>(i);
    const Vector3f axis = ((1 - t) * points[i] + t * points[i + 1]).cast<float>();
    const Vector3f normal = (seen.z_m * ray - axis).normalized();
    return normal.dot(ray) > 0 ? Vector3f(-normal) : normal;
  }

  // What a hit ray of the packet saw.
  [[nodiscard]] Surface surface(const RTCRayHit16& rays, int k, std::uint32_t pixel) const {
    Surface surface;
    surface.pixel = pixel;
    const Source& source = sources[rays.hit.geomID[k]];
    surface.thing = source.thing;
    surface.rope = source.rope;
    surface.strand = source.strand;
    surface.z_m = rays.ray.tfar[k];
    surface.normal = Vector3f(rays.hit.Ng_x[k], rays.hit.Ng_y[k], rays.hit.Ng_z[k]).normalized();
    const Vector3f ray(rays.ray.dir_x[k], rays.ray.dir_y[k], 1);
    if (surface.normal.dot(ray) > 0) surface.normal = -surface.normal;
    if (surface.thing != kRopeThing) return surface;
    const auto primitive = static_cast<float>(rays.hit.primID[k]);
    if (!source.ends) {
      surface.along = (primitive + rays.hit.u[k]) * static_cast<float>(source.stride);
      surface.normal = round_normal(surface, ray);
    } else {
      const auto last = static_cast<float>(view->curves[source.rope].points.size() - 1);
      surface.along = rays.hit.primID[k] == 0 ? 0 : last;
    }
    return surface;
  }
};

Result<Tracer> Tracer::create(const View& view, std::span<const Rope> ropes,
                              std::span<const Thing> things) {
  auto impl = std::make_unique<Impl>();
  impl->view = &view;
  // Callers run many frames side by side: one thread each.
  impl->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!impl->device) return failed(nullptr, "a device");
  impl->scene.reset(rtcNewScene(impl->device.get()));
  if (!impl->scene) return failed(impl->device.get(), "a scene");
  RTCDevice device = impl->device.get();
  RTCScene scene = impl->scene.get();
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  bool made = true;
  for (std::size_t k = 0; made && k < ropes.size(); ++k) {
    const auto number = static_cast<std::uint16_t>(k);
    const Rope& rope = ropes[k];
    const bool laid = rope.cord && rope.cord->strands > 1;
    impl->axes.push_back(strand_axes(rope.cord.value_or(Cord()), view.curves[k], rope.radius_m));
    const double radius_m = rope.radius_m * (laid ? rope.cord->strand_radii() : 1);
    const std::size_t stride = laid ? 1 : kStride;
    for (const auto& axis : impl->axes.back()) {
      const auto strand = static_cast<std::uint8_t>(&axis - impl->axes.back().data());
      made = made && add_strand(device, scene, axis, stride, radius_m, rope.square_ends && !laid);
      impl->sources.push_back({kRopeThing, number, false, strand, stride});
    }
    if (!rope.square_ends || laid) continue;
    made = made && add_ends(device, scene, view.curves[k], rope.radius_m);
    impl->sources.push_back({kRopeThing, number, true});
  }
  for (std::size_t i = 0; made && i < things.size(); ++i) {
    if (!things[i].capsules.empty()) {
      made = made && add_capsules(device, scene, things[i].capsules);
      impl->sources.push_back({static_cast<std::uint16_t>(i), 0, false});
    }
    if (!things[i].boxes.empty()) {
      made = made && add_boxes(device, scene, things[i].boxes);
      impl->sources.push_back({static_cast<std::uint16_t>(i), 0, false});
    }
  }
  if (!made) return failed(device, "the scene's geometry");
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return failed(device, "the scene");
  impl->blocks = blocks_of(view, ropes, things);
  return Tracer(std::move(impl));
}

Picture Tracer::take_picture() const {
  const View& view = *impl_->view;
  const auto width = static_cast<std::size_t>(view.sensor->width);
  const auto pixels = width * static_cast<std::size_t>(view.sensor->height);
  Picture picture;
  picture.depth_m.assign(pixels, 0.0F);
  picture.mask.assign(pixels, 0);
  if (view.has_ground) draw_ground(view, picture.depth_m);
  Packet packet;
  const Blocks& blocks = impl_->blocks;
  for (int row = 0; row < blocks.rows; ++row) {
    for (int column = 0; column < blocks.columns; ++column) {
      if (blocks.wanted[static_cast<std::size_t>(row * blocks.columns + column)] == 0) continue;
      aim(view, column * kBlock_px, row * kBlock_px, picture.depth_m, packet);
      embree::intersect(impl_->scene.get(), packet.valid.data(), packet.rays);
      for (int k = 0; k < 16; ++k) {
        if (packet.valid[static_cast<std::size_t>(k)] == 0) continue;
        if (packet.rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
        const std::size_t pixel =
            static_cast<std::size_t>(row * kBlock_px + k / kBlock_px) * width +
            static_cast<std::size_t>(column * kBlock_px + k % kBlock_px);
        const Surface seen = impl_->surface(packet.rays, k, static_cast<std::uint32_t>(pixel));
        picture.depth_m[pixel] = seen.z_m;
        if (seen.thing == kRopeThing) picture.mask[pixel] = 255;
        picture.surfaces.push_back(seen);
      }
    }
  }
  return picture;
}

bool Tracer::shadowed(const Vector3f& point, const Vector3f& light) const {
  const Vector3f way = light - point;
  RTCRay ray{};
  ray.org_x = point.x();
  ray.org_y = point.y();
  ray.org_z = point.z();
  ray.dir_x = way.x();
  ray.dir_y = way.y();
  ray.dir_z = way.z();
  ray.tnear = 0.0005F / way.norm();
  ray.tfar = 1;
  ray.mask = 0xFFFFFFFFU;
  embree::occluded(impl_->scene.get(), ray);
  return ray.tfar < 0;
}

Tracer::Tracer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;
Tracer::~Tracer() = default;

}  // namespace flowdlo::synth
