#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The whole picture, with what light.frag needs of the frame.
#include "shaders/frame.glsl"
#include "shaders/lit_frame.glsl"
#include "shaders/corners.glsl"

layout(location = 0) flat out vec4 lit_inputs[LIT_INPUTS];

void main() {
    pack(of_block(), lit_inputs);
    gl_Position = corner(gl_VertexIndex);
}
