// Embree 3 (Debian 12) and 4 (Debian 13) with the same calls. Only targets that link `embree` may include
// this header; they get BOLT_EMBREE, the major version, from cmake/packages.cmake.
#pragma once

#if BOLT_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace bolt::embree {

// Finds the nearest hit of the ray, as rtcIntersect1 does with default arguments.
inline void intersect(RTCScene scene, RTCRayHit& ray) {
#if BOLT_EMBREE >= 4
    rtcIntersect1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
#endif
}

// True if anything lies on the ray between tnear and tfar.
inline bool occluded(RTCScene scene, RTCRay& ray) {
#if BOLT_EMBREE >= 4
    rtcOccluded1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
    return ray.tfar < 0.0F;  // Embree sets tfar to −∞ if the ray is blocked
}

}  // namespace bolt::embree
