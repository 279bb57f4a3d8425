// Embree: the two versions that distributions ship, behind one spelling.
#pragma once

#ifdef FLOWDLO_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>

namespace flowdlo::synth::embree {

template <auto kRelease>
struct Releaser {
  template <class T>
  void operator()(T* object) const {
    kRelease(object);
  }
};
using Device = std::unique_ptr<RTCDeviceTy, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<RTCSceneTy, Releaser<rtcReleaseScene>>;
using Geometry = std::unique_ptr<RTCGeometryTy, Releaser<rtcReleaseGeometry>>;

inline void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
#ifdef FLOWDLO_EMBREE_4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &rays, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rays);
#endif
}

inline void occluded(RTCScene scene, RTCRay& ray) {
#ifdef FLOWDLO_EMBREE_4
  rtcOccluded1(scene, &ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace flowdlo::synth::embree
