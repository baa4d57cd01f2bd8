#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Writes the geometry buffer and the material buffer.
#define MATERIAL_OUTPUTS
#include "shaders/surface_main.glsl"
