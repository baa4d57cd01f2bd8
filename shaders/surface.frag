#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the geometry buffer, for parts whose values are the material's constants.
#include "shaders/surface_main.glsl"
