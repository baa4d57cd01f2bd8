#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Draws an outline of even width around marked shapes: an unmarked pixel takes the strongest mark on two
// rings around it.
#include "shaders/frame.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray marks;
layout(location = 0) out vec4 color_out;

const int directions = 12;

void main() {
    const vec3 here = vec3(gl_FragCoord.xy * frame.picture.zw, view_index);
    vec4 strongest = vec4(0.0);
    for (int ring = 1; ring <= 2; ++ring)
        for (int i = 0; i < directions; ++i) {
            const float angle = (float(i) + 0.5 * float(ring)) * 6.28318530718 / float(directions);
            const vec2 step = vec2(cos(angle), sin(angle)) * (0.5 * float(ring) * frame.outline_px);
            const vec4 mark = textureLod(marks, vec3(here.xy + step * frame.picture.zw, here.z), 0.0);
            if (mark.a > strongest.a) strongest = mark;
        }
    const float inside = textureLod(marks, here, 0.0).a;
    color_out = strongest * (1.0 - (strongest.a > 0.0 ? inside / strongest.a : 0.0));
}
