#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_multiview : require
// Depth at half the size: of the sample nearest to the middle of four pixels.
layout(set = 0, binding = 3) uniform sampler2DMSArray depths;

void main() {
    gl_FragDepth = texelFetch(depths, ivec3(2 * ivec2(gl_FragCoord.xy), gl_ViewIndex), 3).r;
}
