// Averages the ambient occlusion of the 4 × 4 slices of shaders/occlusion.glsl over pixels on the same
// surface. A pixel belongs to the surface if its depth agrees with the tangent plane: on a plane, depth is
// linear in the picture, with a slope that follows from the normal.
#include "shaders/frame.glsl"
#include "shaders/half_size.glsl"
#include "shaders/surface.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray depth_map;
layout(set = 0, binding = 4) uniform sampler2DArray raw_map;
layout(set = 0, binding = 5) uniform sampler2DMSArray surfaces;

// Returns the smoothed visibility at a texel of the view `at.z`; 1 without geometry.
float smoothed(ivec3 at) {
    const ivec2 last = textureSize(depth_map, 0).xy - 1;
    const float here = texelFetch(depth_map, at, 0).r;
    if (here <= 0.0 || here >= 1.0) return 1.0;
    const vec3 n = unpack_normal(texelFetch(surfaces, full_texel(at), small_sample).xy);
    // Planes are transformed to clip space by the transposed inverse.
    const mat4 world_from_clip = frame.views[view_index].world_from_clip;
    const vec4 p = world_from_clip * vec4(sample_uv(at.xy) * 2.0 - 1.0, here, 1.0);
    const vec4 plane = vec4(n, -dot(n, p.xyz / p.w)) * world_from_clip;
    const vec2 slope = abs(plane.z) > 1e-9 ? -plane.xy / plane.z * (4.0 * frame.picture.zw) : vec2(0.0);
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            const ivec3 there = ivec3(clamp(at.xy + ivec2(x, y), ivec2(0), last), at.z);
            // Reversed depth is proportional to 1 / distance, so compare relative differences.
            const float off = texelFetch(depth_map, there, 0).r - here - dot(slope, vec2(there.xy - at.xy));
            const float weight = abs(off) < 0.02 * here ? 1.0 : 0.001;
            sum += weight * texelFetch(raw_map, there, 0).r;
            weights += weight;
        }
    }
    return sum / weights;
}
