#version 460
#extension GL_GOOGLE_include_directive : require
// Covers the whole picture.
#include "shaders/corners.glsl"

void main() { gl_Position = corner(gl_VertexIndex); }
