#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Shades the geometry buffer; light.comp does the same in a compute shader.
#include "shaders/shade_pixel.glsl"

layout(location = 0) flat in vec4 lit_inputs[LIT_INPUTS];
layout(location = 0) out vec4 color_out;

void main() {
    lit_frame = unpack(lit_inputs);
    color_out = shade_pixel(ivec3(gl_FragCoord.xy, view_index));
}
