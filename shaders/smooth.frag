#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the smoothed ambient occlusion; smooth.comp does the same in a compute shader.
#include "shaders/smooth.glsl"

layout(location = 0) out float visibility_out;

void main() { visibility_out = smoothed(ivec3(gl_FragCoord.xy, view_index)); }
