#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Samples a panel once in each quarter of the pixel, hides it behind parts, and smooths its border.
#include "shaders/shared.h"
#include "shaders/features.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in float opacity;

layout(set = 0, binding = 1) uniform sampler2DArray picture;  // premultiplied
layout(set = 0, binding = 2) uniform sampler2DMSArray depths;
layout(location = 0) out vec4 color_out;

const vec2 taps[4] = vec2[](vec2(-0.25, -0.25), vec2(0.25, -0.25), vec2(-0.25, 0.25), vec2(0.25, 0.25));

void main() {
    const vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
    vec4 texel = vec4(0.0);
    float hidden = 0.0;
    for (int i = 0; i < 4; ++i) {
        texel += 0.25 * textureLod(picture, vec3(uv + taps[i].x * uv_x + taps[i].y * uv_y, 0.0), 0.0);
        hidden += texelFetch(depths, ivec3(gl_FragCoord.xy, view_index), i).r > gl_FragCoord.z ? 0.25 : 0.0;
    }
    const vec2 border = clamp((0.5 - abs(uv - 0.5)) / max(abs(uv_x) + abs(uv_y), 1e-6) + 0.5, 0.0, 1.0);
    color_out = texel * (opacity * border.x * border.y * (1.0 - hidden));
}
