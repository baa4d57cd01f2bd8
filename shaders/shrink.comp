#version 460
#extension GL_GOOGLE_include_directive : require
// Halves the depth buffer, as shrink.frag does.
#include "shaders/compute.glsl"
#include "shaders/frame.glsl"
#include "shaders/half_size.glsl"

layout(set = 0, binding = 3) uniform sampler2DMSArray depths;
layout(set = 0, binding = 6, r32f) uniform writeonly image2DArray small_depths;

void main() {
    const ivec3 at = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(at.xy, imageSize(small_depths).xy)))
        imageStore(small_depths, at, vec4(texelFetch(depths, full_texel(at), small_sample).r));
}
