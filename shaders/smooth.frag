#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The mean over the pattern of 4 × 4 slices, of those pixels that lie on the same surface.
#include "shaders/frame.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray depth_map;
layout(set = 0, binding = 4) uniform sampler2DArray raw_map;
layout(location = 0) out float free_out;

void main() {
    const ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depth_map, 0).xy - 1;
    const float here = texelFetch(depth_map, ivec3(at, gl_ViewIndex), 0).r;
    float sum = 0.0, weights = 0.0;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            const ivec3 there = ivec3(clamp(at + ivec2(x, y), ivec2(0), last), gl_ViewIndex);
            // Reversed depth is proportional to one over the distance: compare by ratio.
            const float ratio = texelFetch(depth_map, there, 0).r / max(here, 1e-7);
            const float weight = abs(ratio - 1.0) < 0.03 ? 1.0 : 0.001;
            sum += weight * texelFetch(raw_map, there, 0).r;
            weights += weight;
        }
    }
    free_out = sum / weights;
}
