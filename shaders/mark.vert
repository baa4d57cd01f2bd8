#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Draws outlined parts as flat shapes.
#include "shaders/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) flat out vec4 outline;

void main() {
    outline = instances[gl_InstanceIndex].outline;
    gl_Position = frame.views[view_index].clip_from_world *
                  (instances[gl_InstanceIndex].world_from_object * vec4(position, 1.0));
}
