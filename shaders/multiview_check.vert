#version 460
// A triangle that extends beyond the picture, so that the driver clips it.
const vec2 corners[3] = vec2[](vec2(-5, -5), vec2(15, -5), vec2(-5, 15));

void main() { gl_Position = vec4(corners[gl_VertexIndex], 0.5, 1.0); }
