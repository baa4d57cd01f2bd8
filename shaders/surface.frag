#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The geometry buffer of a frame without values that vary over a part.
#include "shaders/surface_main.glsl"
