#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Labels in the scene: six vertices per glyph, read from buffers.
#include "shaders/shared.h"
#include "shaders/features.glsl"
#include "shaders/labels.h"

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };
layout(set = 0, binding = 1, std430) readonly buffer Labels { LabelFrame labels[]; };
layout(set = 0, binding = 2, std430) readonly buffer Quads { LabelQuad quads[]; };

layout(location = 0) out vec2 em;
layout(location = 1) out vec2 uv_or_half_size;  // glyph: uv in the atlas; plate: half width and height, em
layout(location = 2) flat out vec4 color;
layout(location = 3) flat out float growth_or_radius;  // em; glyph: beyond its edge; plate: corner radius
layout(location = 4) flat out float hidden_opacity;    // 0 … 1, factor on the opacity behind parts
layout(location = 5) flat out float is_plate;          // 1: a background; 0: a glyph
layout(location = 6) flat out vec2 middle;
layout(location = 7) noperspective out float depth;  // compared with the depth of parts

void main() {
    const LabelQuad quad = quads[gl_VertexIndex / 6];
    const LabelFrame label = labels[quad.label];
    const int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexIndex % 6];
    const vec2 side = vec2(corner & 1, corner >> 1);
    em = mix(quad.rect.xy, quad.rect.zw, side);
    uv_or_half_size = quad.plate != 0u ? quad.uv.xy : mix(quad.uv.xy, quad.uv.zw, side);
    color = quad.color;
    growth_or_radius = quad.grow;
    hidden_opacity = label.up.w;
    is_plate = float(quad.plate);
    middle = 0.5 * (quad.rect.xy + quad.rect.zw);

    const View view = frame.views[view_index];
    const vec2 pixel = 2.0 * frame.picture.zw;  // in clip space, before the perspective division
    vec2 moved = label.pixels.xy;
    vec3 at = label.position.xyz;
    if (label.right.w == LABEL_FIXED) {
        at += label.position.w * (em.x * label.right.xyz + em.y * label.up.xyz);
    } else if (label.right.w == LABEL_FACING) {
        // Along these vectors only the picture's x or y changes, for every projection.
        const vec3 right = normalize(view.world_from_clip[0].xyz), up = -normalize(view.world_from_clip[1].xyz);
        at += label.position.w * (em.x * right + em.y * up);
    } else {
        moved += label.position.w * em;
    }
    const vec3 to_eye = view.eye.xyz - at;
    const float nearer = min(label.pixels.z, 0.9 * length(to_eye));
    const vec4 before = view.clip_from_world * vec4(at + nearer * normalize(to_eye), 1.0);
    depth = before.z / before.w;
    gl_Position = view.clip_from_world * vec4(at, 1.0);
    gl_Position.xy += moved * vec2(pixel.x, -pixel.y) * gl_Position.w;
}
