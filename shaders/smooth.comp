#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the smoothed ambient occlusion, as smooth.frag does.
#include "shaders/compute.glsl"
#include "shaders/smooth.glsl"

layout(set = 0, binding = 6, rgba8) uniform writeonly image2DArray visibility;

void main() {
    const ivec3 at = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(at.xy, imageSize(visibility).xy))) imageStore(visibility, at, vec4(smoothed(at)));
}
