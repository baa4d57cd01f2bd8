#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// A flat picture in the scene: two triangles.
#include "shaders/shared.h"
#include "shaders/features.glsl"

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };

layout(push_constant) uniform Push {
    vec4 centre;
    vec4 right;  // from the centre to the middle of the right edge; w: opacity
    vec4 up;     // from the centre to the middle of the upper edge
};

layout(location = 0) out vec2 uv;
layout(location = 1) flat out float opacity;

void main() {
    const int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexIndex];
    const vec2 side = vec2(corner & 1, corner >> 1);
    uv = vec2(side.x, 1.0 - side.y);
    opacity = right.w;
    const vec3 at = centre.xyz + (2.0 * side.x - 1.0) * right.xyz + (2.0 * side.y - 1.0) * up.xyz;
    gl_Position = frame.views[view_index].clip_from_world * vec4(at, 1.0);
}
