#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/frame.glsl"
#include "shaders/environment.glsl"
#include "shaders/tone.glsl"

layout(set = 0, binding = 4) uniform samplerCube specular_levels;
layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 color_out;

void main() {
    const vec3 color = frame.background.w > 0.5 ? frame.background.rgb : specular_light(specular_levels, direction, 0.0);
    color_out = vec4(pbr_neutral(color * frame.environment.w), 1.0);
}
