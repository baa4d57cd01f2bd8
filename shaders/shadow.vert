#version 460
#extension GL_GOOGLE_include_directive : require
// Draws parts into the shadow map of light 0.
#include "shaders/frame.glsl"

layout(location = 0) in vec3 position;

void main() {
    gl_Position = frame.shadow_from_world * (instances[gl_InstanceIndex].world_from_object * vec4(position, 1.0));
}
