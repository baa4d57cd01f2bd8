#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Halves the depth buffer.
#include "shaders/frame.glsl"
#include "shaders/half_size.glsl"

layout(set = 0, binding = 3) uniform sampler2DMSArray depths;

void main() {
    gl_FragDepth = texelFetch(depths, full_texel(ivec3(gl_FragCoord.xy, view_index)), small_sample).r;
}
