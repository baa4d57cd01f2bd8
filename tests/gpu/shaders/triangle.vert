#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/gpu/shaders/common.glsl"

layout(location = 0) in vec3 position;
layout(location = 3) in vec2 unused_by_some;
layout(push_constant) uniform Push { vec4 offset; } push;
layout(set = 0, binding = 0) uniform View { mat4 clip; } view;
layout(location = 0) out vec2 at;

void main() {
    at = unused_by_some * half_size;
    gl_Position = view.clip * vec4(position, 1.0) + push.offset;
}
