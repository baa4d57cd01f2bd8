#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Blends the forward layer over the shaded surfaces.
#include "shaders/frame.glsl"

layout(set = 0, binding = 3) uniform sampler2DArray over;
layout(location = 0) out vec4 color_out;

void main() { color_out = texelFetch(over, ivec3(gl_FragCoord.xy, view_index), 0); }
