#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Computes the fraction of a pixel that a glyph covers, from its distance field. Samples the field once in
// each quarter of the pixel and converts each distance to coverage by a linear ramp. The ramp is as wide as
// that quarter, measured across the edge.

#include "shaders/shared.h"
#include "shaders/features.glsl"

layout(location = 0) in vec2 em;
layout(location = 1) in vec2 uv_or_half_size;
layout(location = 2) flat in vec4 color;
layout(location = 3) flat in float growth_or_radius;
layout(location = 4) flat in float hidden_opacity;
layout(location = 5) flat in float is_plate;
layout(location = 6) flat in vec2 middle;
layout(location = 7) noperspective in float depth;

layout(set = 0, binding = 3) uniform sampler2D atlas;
layout(set = 0, binding = 4) uniform sampler2DMSArray depths;
layout(location = 0) out vec4 color_out;

const vec2 taps[4] = vec2[](vec2(-0.25, -0.25), vec2(0.25, -0.25), vec2(-0.25, 0.25), vec2(0.25, 0.25));

// Distance to the edge of a rounded rectangle, positive inside.
float plate_distance(vec2 at) {
    const vec2 beyond = abs(at - middle) - (uv_or_half_size - growth_or_radius);
    return growth_or_radius - length(max(beyond, 0.0)) - min(max(beyond.x, beyond.y), 0.0);
}

void main() {
    const vec2 em_x = dFdx(em), em_y = dFdy(em);  // one pixel on the screen
    const vec2 uv_x = dFdx(uv_or_half_size), uv_y = dFdy(uv_or_half_size);
    float d[4];
    for (int i = 0; i < 4; ++i)
        d[i] = is_plate > 0.5
                   ? plate_distance(em + taps[i].x * em_x + taps[i].y * em_y)
                   : textureLod(atlas, uv_or_half_size + taps[i].x * uv_x + taps[i].y * uv_y, 0.0).r +
                         growth_or_radius;
    // The edge's normal in the glyph's plane, from the screen derivatives of the distance. `across` is the
    // width of a pixel along this normal.
    const vec2 change = vec2(d[1] + d[3] - d[0] - d[2], d[2] + d[3] - d[0] - d[1]);
    vec2 normal = vec2(change.x * em_y.y - change.y * em_x.y, change.y * em_x.x - change.x * em_y.x);
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : vec2(0.70710678);
    const float across = max(length(vec2(dot(em_x, normal), dot(em_y, normal))), 1e-9);
    float covered = 0.0;
    for (int i = 0; i < 4; ++i) covered += 0.25 * clamp(d[i] / (0.5 * across) + 0.5, 0.0, 1.0);

    float hidden = 0.0;
    for (int i = 0; i < 4; ++i)
        hidden += texelFetch(depths, ivec3(gl_FragCoord.xy, view_index), i).r > depth ? 0.25 : 0.0;
    const float alpha = color.a * covered * mix(1.0, hidden_opacity, hidden);
    color_out = vec4(color.rgb * alpha, alpha);
}
