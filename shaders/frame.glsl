// Set 0: what is the same for the whole frame.
#include "shaders/shared.h"

layout(set = 0, binding = 0, std140) uniform FrameBlock { Frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 2, std430) readonly buffer Materials { Material materials[]; };
