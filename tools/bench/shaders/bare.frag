#version 460

layout(push_constant) uniform Push {
    mat4 clip_from_object;
    vec4 color;
} push;

layout(location = 0) out vec4 color_out;

void main() { color_out = push.color; }
