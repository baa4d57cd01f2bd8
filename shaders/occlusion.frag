#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the ambient occlusion of each texel; occlusion.comp does the same in a compute shader.
#include "shaders/occlusion.glsl"

layout(location = 0) out float visibility_out;

void main() { visibility_out = unoccluded(ivec3(gl_FragCoord.xy, view_index)); }
