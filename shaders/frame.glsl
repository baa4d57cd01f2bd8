// Set 0: data of the whole frame. Do not branch on these values alone: lavapipe (Mesa 22.3) compiles the
// outcome of such a branch into the code, so it recompiles for every new block, that is in every frame. Use a
// SCENE_… bit instead.
#include "shaders/shared.h"
#include "shaders/features.glsl"

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameData frame; };
layout(set = 0, binding = 1, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 2, std430) readonly buffer Materials { Material materials[]; };
