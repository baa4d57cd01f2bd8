#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Covers the whole picture and passes the frame data to light.frag.
#include "shaders/frame.glsl"
#include "shaders/lit_frame.glsl"
#include "shaders/corners.glsl"

layout(location = 0) flat out vec4 lit_inputs[LIT_INPUTS];

void main() {
    pack(load_lit_frame(), lit_inputs);
    gl_Position = corner(gl_VertexIndex);
}
