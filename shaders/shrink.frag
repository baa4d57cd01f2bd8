#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Depth at half the size: of the sample nearest to the middle of four pixels.
layout(set = 0, binding = 3) uniform sampler2DMSArray depths;
layout(location = 0) out float depth_out;

void main() {
    depth_out = texelFetch(depths, ivec3(2 * ivec2(gl_FragCoord.xy), gl_ViewIndex), 3).r;
}
