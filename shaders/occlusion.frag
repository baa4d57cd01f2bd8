#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// How much of the sky above a surface its neighbours leave free, from the depth of what is seen: one slice through the view
// direction a pixel, turned over a pattern of 4 × 4 pixels, with the horizons of both sides integrated in closed form.
//   J. Jimenez, X.-C. Wu, A. Pesce, A. Jarabo, Practical Real-Time Strategies for Accurate Indirect Occlusion, 2016.
#include "shaders/frame.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray depth_map;
layout(location = 0) out float free_out;

const float pi = 3.14159265358979;
const int steps = 4;

vec3 world_at(vec2 uv, float depth) {
    const vec4 p = frame.views[gl_ViewIndex].world_from_clip * vec4(uv * 2.0 - 1.0, depth, 1.0);
    return p.xyz / p.w;
}

vec3 seen_at(vec2 uv) { return world_at(uv, max(textureLod(depth_map, vec3(uv, gl_ViewIndex), 0.0).r, 1e-7)); }

// Of two differences the one that stays on the surface.
vec3 shorter(vec3 a, vec3 b) { return dot(a, a) < dot(b, b) ? a : b; }

// The cosine of the highest horizon on one side.
float horizon(vec2 uv, vec2 way, vec3 p, vec3 v, float jitter) {
    float highest = -1.0;
    const float radius = frame.occlusion.x;
    for (int i = 0; i < steps; ++i) {
        const float t = (float(i) + jitter) / float(steps);
        const vec3 d = seen_at(uv + way * (t * t)) - p;
        const float far = clamp(dot(d, d) / (radius * radius), 0.0, 1.0);
        highest = max(highest, mix(dot(d, v) * inversesqrt(max(dot(d, d), 1e-12)), -1.0, far * far));
    }
    return highest;
}

void main() {
    const vec2 texel = 1.0 / vec2(textureSize(depth_map, 0).xy);
    const vec2 uv = gl_FragCoord.xy * texel;
    const float depth = textureLod(depth_map, vec3(uv, gl_ViewIndex), 0.0).r;
    const vec3 p = world_at(uv, max(depth, 1e-7));
    const vec3 eye = frame.views[gl_ViewIndex].eye.xyz - p;
    const vec3 v = normalize(eye);
    const vec3 right = shorter(seen_at(uv + vec2(texel.x, 0.0)) - p, p - seen_at(uv - vec2(texel.x, 0.0)));
    const vec3 down = shorter(seen_at(uv + vec2(0.0, texel.y)) - p, p - seen_at(uv - vec2(0.0, texel.y)));
    vec3 n = normalize(cross(down, right));
    n = dot(n, v) < 0.0 ? -n : n;

    const uvec2 cell = uvec2(gl_FragCoord.xy) & 3u;
    const float turn = (float((cell.x + cell.y * 4u) * 7u % 16u) + 0.5) * (pi / 16.0);
    const float jitter = fract(float(cell.x * 3u + cell.y) * 0.61803);
    const vec2 way = vec2(cos(turn), sin(turn));
    // The radius as large as it is seen, but no more than a sixth of the picture.
    const float across = length(world_at(uv + vec2(texel.x, 0.0), max(depth, 1e-7)) - p);
    const float pixels = clamp(frame.occlusion.x / max(across, 1e-9), 2.0, 1.0 / (6.0 * texel.y));
    const vec2 reach = way * pixels * texel;

    const vec3 along = normalize(world_at(uv + way * texel, max(depth, 1e-7)) - p);
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
    free_out = depth > 0.0 ? clamp(0.25 * weight * sum, 0.0, 1.0) : 1.0;
}
