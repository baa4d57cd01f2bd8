// Set 0: what is the same for the whole frame. No branch that these numbers alone decide: lavapipe (Mesa 22.3) puts what decides
// it into the code and compiles anew with every block, which is every frame. Such a choice is a SCENE_… bit.
#include "shaders/shared.h"
#include "shaders/features.glsl"

layout(set = 0, binding = 0, std140) uniform FrameBlock { Frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 2, std430) readonly buffer Materials { Material materials[]; };
