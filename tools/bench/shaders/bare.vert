#version 460

layout(push_constant) uniform Push {
    mat4 clip_from_object;
    vec4 color;
} push;

layout(location = 0) in vec3 position;

void main() { gl_Position = push.clip_from_object * vec4(position, 1.0); }
