#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// The geometry buffer for parts without values that vary over them.
#include "shaders/surface_main.glsl"
