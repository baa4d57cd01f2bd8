#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// What lies behind everything, where nothing was drawn.
#include "shaders/frame.glsl"
#include "shaders/environment.glsl"
#include "shaders/tone.glsl"

layout(set = 0, binding = 4) uniform samplerCube specular_levels;
layout(location = 0) out vec4 color_out;

void main() {
    const View view = frame.views[gl_ViewIndex];
    const vec4 far = view.world_from_clip * vec4(gl_FragCoord.xy * frame.picture.zw * 2.0 - 1.0, 1e-6, 1.0);
    const vec3 way = far.xyz / far.w - view.eye.xyz;
    color_out = vec4(pbr_neutral(specular_light(specular_levels, way, 0.0) * frame.environment.w), 1.0);
}
