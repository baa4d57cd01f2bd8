// Ambient occlusion from the depth buffer: one slice through the view direction per pixel, rotated in a
// pattern of 4 × 4 pixels, with the visible angle between the horizons of both sides integrated in closed
// form.
//   J. Jimenez, X.-C. Wu, A. Pesce, A. Jarabo, Practical Real-Time Strategies for Accurate Indirect
//   Occlusion, 2016.
#include "shaders/frame.glsl"
#include "shaders/half_size.glsl"
#include "shaders/surface.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray depth_map;
layout(set = 0, binding = 5) uniform sampler2DMSArray surfaces;

const float pi = 3.14159265358979;
const int steps = 4;

vec3 world_at(vec2 uv, float depth) {
    const vec4 p = frame.views[view_index].world_from_clip * vec4(uv * 2.0 - 1.0, depth, 1.0);
    return p.xyz / p.w;
}

// Returns the visible point of the depth sample nearest to this location. Interpolated depths would make
// surfaces at grazing angles occlude themselves.
vec3 sample_point(vec2 uv) {
    const ivec2 size = textureSize(depth_map, 0).xy;
    const ivec2 texel = clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1);
    return world_at(sample_uv(texel), max(texelFetch(depth_map, ivec3(texel, view_index), 0).r, 1e-7));
}

// Returns the cosine of the angle between the view direction and the highest horizon on one side.
float horizon(vec2 uv, vec2 direction, vec3 p, vec3 v, float jitter) {
    float highest = -1.0;
    const float radius = frame.occlusion.x;
    for (int i = 0; i < steps; ++i) {
        const float t = (float(i) + jitter) / float(steps);
        const vec3 d = sample_point(uv + direction * (t * t)) - p;
        const float far = clamp(dot(d, d) / (radius * radius), 0.0, 1.0);
        highest = max(highest, mix(dot(d, v) * inversesqrt(max(dot(d, d), 1e-12)), -1.0, far * far));
    }
    return highest;
}

// Returns the unoccluded fraction of the hemisphere at a texel of the view `at.z`; 1 without geometry.
float unoccluded(ivec3 at) {
    const float depth = texelFetch(depth_map, at, 0).r;
    if (depth <= 0.0 || depth >= 1.0) return 1.0;  // nothing, or an area that is never seen
    const vec2 texel = 1.0 / vec2(textureSize(depth_map, 0).xy);
    const vec2 uv = (vec2(at.xy) + 0.5) * texel;
    const vec3 p = world_at(sample_uv(at.xy), depth);
    const vec3 eye = frame.views[view_index].eye.xyz - p;
    const vec3 v = normalize(eye);
    vec3 n = unpack_normal(texelFetch(surfaces, full_texel(at), small_sample).xy);
    n = dot(n, v) < 0.0 ? normalize(n - dot(n, v) * v) : n;

    const uvec2 cell = uvec2(at.xy) & 3u;
    const float turn = (float((cell.x + cell.y * 4u) * 7u % 16u) + 0.5) * (pi / 16.0);
    const float jitter = fract(float(cell.x * 3u + cell.y) * 0.61803);
    const vec2 direction = vec2(cos(turn), sin(turn));
    // The projected radius, limited to a sixth of the picture.
    const vec2 here = sample_uv(at.xy);
    const float across = length(world_at(here + vec2(texel.x, 0.0), depth) - p);
    const float pixels = clamp(frame.occlusion.x / max(across, 1e-9), 2.0, 1.0 / (6.0 * texel.y));
    const vec2 reach = direction * pixels * texel;

    const vec3 along = normalize(world_at(here + direction * texel, depth) - p);
    const vec3 side = along - v * dot(along, v);
    const vec3 axis = normalize(cross(along, v));
    const vec3 flat_n = n - axis * dot(n, axis);
    const float weight = max(length(flat_n), 1e-4);
    const float gamma = sign(dot(side, flat_n)) * acos(clamp(dot(flat_n, v) / weight, -1.0, 1.0));
    const float ahead = acos(clamp(horizon(uv, reach, p, v, jitter), -1.0, 1.0));
    const float behind = -acos(clamp(horizon(uv, -reach, p, v, jitter), -1.0, 1.0));
    const float h1 = gamma + clamp(behind - gamma, -0.5 * pi, 0.5 * pi);
    const float h2 = gamma + clamp(ahead - gamma, -0.5 * pi, 0.5 * pi);
    const float sum = 2.0 * cos(gamma) + 2.0 * (h1 + h2) * sin(gamma) - cos(2.0 * h1 - gamma) - cos(2.0 * h2 - gamma);
    // At silhouettes one texel covers more of the surface than the radius, so no occlusion can be computed.
    const float confidence = smoothstep(0.02, 0.2, dot(n, v));
    return mix(1.0, clamp(0.25 * weight * sum, 0.0, 1.0), confidence);
}
