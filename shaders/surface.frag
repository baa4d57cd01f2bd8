#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the geometry buffer, for parts whose material does not vary over the part.
#include "shaders/surface_main.glsl"
