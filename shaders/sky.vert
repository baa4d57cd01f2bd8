#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
#include "shaders/frame.glsl"

layout(location = 0) out vec3 direction;

// One triangle over the whole picture, as far away as can be.
void main() {
    const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    const View view = frame.views[gl_ViewIndex];
    const vec4 far = view.world_from_clip * vec4(corner, 1e-6, 1.0);
    direction = far.xyz / far.w - view.eye.xyz;
    gl_Position = vec4(corner, 0.0, 1.0);
}
